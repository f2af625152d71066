#include "renderer/pages/html_page.h"

#include <fmt/format.h>

#include "renderer/base/color.h"
#include "renderer/output/image_io.h"
#include "renderer/output/spp_map.h"
#include "renderer/pages/embedded.h"

namespace lull {

namespace {

constexpr int64_t kMostPagePixels = 4 << 20;  // of a picture

std::string Uri(std::span<const Rgb> pixels, int width, int height) {
    return "data:image/png;base64," + Base64(EncodePng(pixels, width, height));
}

}  // namespace

std::string Base64(std::span<const std::byte> bytes) {
    constexpr const char* digits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t group = 0;
        for (size_t k = i; k < i + 3; ++k)
            group = group << 8 | (k < bytes.size() ? uint32_t(bytes[k]) : 0);
        for (int k = 0; k < 4; ++k)
            text += i + size_t(k) > bytes.size() ? '=' : digits[group >> (18 - 6 * k) & 63];
    }
    return text;
}

std::string JsonForScript(const Json& json) {
    // Only "</" and "<!--" have a meaning there.
    std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
    for (size_t at = 0; (at = text.find('<', at)) != std::string::npos; at += 6)
        text.replace(at, 1, "\\u003c");
    return text;
}

std::string FillPage(std::string_view frame, const std::map<std::string, std::string>& pieces) {
    // Names in the data are never read as places to fill in: each piece is copied once.
    std::string page;
    std::string_view rest = EmbeddedFile(frame);
    while (!rest.empty()) {
        const size_t open = rest.find("{{"), close = rest.find("}}", open);
        page += rest.substr(0, open);
        if (close == std::string_view::npos) break;
        const std::string name(rest.substr(open + 2, close - open - 2));
        if (const auto piece = pieces.find(name); piece != pieces.end())
            page += piece->second;
        else
            page += EmbeddedFile(name);
        rest.remove_prefix(close + 2);
    }
    return page;
}

std::string MakePage(const Json& data) {
    return FillPage("page.html", {{"data", JsonForScript(data)}});
}

std::vector<Rgb> PixelsOf(const RgbImage& image) {
    std::vector<Rgb> pixels;
    pixels.reserve(image.values.size() / 3);
    for (size_t i = 0; i < image.values.size(); i += 3)
        pixels.emplace_back(image.values[i], image.values[i + 1], image.values[i + 2]);
    return pixels;
}

std::string PictureUri(const RgbImage& image) {
    return Uri(PixelsOf(image), image.width, image.height);
}

std::string MapUri(std::span<const float> values, int width, int height) {
    std::vector<Rgb> pixels;
    pixels.reserve(values.size());
    for (const float value : values)
        pixels.push_back(Viridis(value).unaryExpr([](float v) { return LinearFromSrgb(v); }));
    return Uri(pixels, width, height);
}

Json CurvesJson(const BlockCurves& curves) {
    return {{"spp", curves.spp}, {"entropy", curves.entropy}, {"noise", curves.noise}};
}

int PagePictureScale(const PixelRect& region) {
    int scale = 1;
    const auto sides = [&](int size) { return int64_t((size + scale - 1) / scale); };
    while (sides(region.Width()) * sides(region.Height()) > kMostPagePixels) ++scale;
    return scale;
}

RgbImage PagePicture(const Film& film) {
    const PixelRect& region = film.Region();
    const int scale = PagePictureScale(region);
    RgbImage picture{
        (region.Width() + scale - 1) / scale, (region.Height() + scale - 1) / scale, {}};
    picture.values.reserve(size_t(picture.width) * size_t(picture.height) * 3);
    FilmView view;
    for (int y = region.min.y(); y < region.max.y(); y += scale)
        for (int x = region.min.x(); x < region.max.x(); x += scale) {
            const Vec2i end = region.max.cwiseMin(Vec2i(x + scale, y + scale));
            film.Extract({{x, y}, end}, false, &view);
            const size_t count = view.mean.size() / 3;
            std::array<double, 3> sum = {};
            for (size_t i = 0; i < view.mean.size(); ++i) sum[i % 3] += double(view.mean[i]);
            for (const double s : sum) picture.values.push_back(float(s / double(count)));
        }
    return picture;
}

std::string MakeRenderPage(const Provenance& provenance, const RenderResult& result,
                           const Film& film, const std::vector<BlockHistory>& histories,
                           const std::map<std::string, int>& warnings) {
    Json page = ReportJson(provenance, result, film.RejectedCount(), warnings);
    Json image = {{"name", "image"},
                  {"label", "image (" + provenance.criterion + ")"},
                  {"rule", provenance.criterion},
                  {"src", PictureUri(PagePicture(film))},
                  {"blocks", Json::array()}};
    for (size_t i = 0; i < result.blocks.size(); ++i) {
        const BlockResult& block = result.blocks[i];
        Json& json = page["blocks"][i];
        json["x"] = block.block.pixels.min.x() - film.Region().min.x();
        json["y"] = block.block.pixels.min.y() - film.Region().min.y();
        if (i < histories.size()) json["curves"] = CurvesJson(histories[i].curves);
        image["blocks"].push_back({{"spp", block.block.spp},
                                   {"seconds", block.seconds},
                                   {"ruleSeconds", block.criterionSeconds}});
    }
    if (const int scale = PagePictureScale(film.Region()); scale > 1)
        page["notes"] = {fmt::format(
            "The picture is the mean of {0}x{0} pixels: the image would be too large for a page. "
            "All pixels are in its PNG and EXR.",
            scale)};
    page["kind"] = "render";
    page["title"] = provenance.scene;
    page["cap"] = provenance.schedule.cap;
    page["width"] = film.Region().Width();
    page["height"] = film.Region().Height();
    page["images"] = {std::move(image)};
    return MakePage(page);
}

}  // namespace lull
