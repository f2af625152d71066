#include "renderer/pages/html_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "renderer/base/math.h"
#include "renderer/film/spp_map.h"
#include "renderer/image/image_io.h"

namespace lull {

namespace {

constexpr int64_t kMostPagePixels = 4 << 20;  // of a picture

std::string Uri(std::span<const Rgb> pixels, int width, int height) {
    return "data:image/png;base64," + Base64(EncodePng(pixels, width, height));
}

// Returns how many squares of `scale` pixels a side there are along `size` pixels, the last less.
int Shrunk(int size, int scale) { return (size + scale - 1) / scale; }

std::vector<float> Shrink(std::span<const float> values, int width, int height, int channels,
                          int scale) {
    std::vector<float> means;
    means.reserve(size_t(Shrunk(width, scale)) * size_t(Shrunk(height, scale)) * size_t(channels));
    for (int top = 0; top < height; top += scale)
        for (int left = 0; left < width; left += scale)
            for (int c = 0; c < channels; ++c) {
                const int right = std::min(left + scale, width),
                          bottom = std::min(top + scale, height);
                double sum = 0;
                for (int y = top; y < bottom; ++y)
                    for (int x = left; x < right; ++x)
                        sum += double(
                            values[size_t(channels) * (size_t(y) * size_t(width) + size_t(x)) +
                                   size_t(c)]);
                means.push_back(float(sum / ((right - left) * (bottom - top))));
            }
    return means;
}

std::vector<Rgb> PixelsOf(const RgbImage& image) {
    std::vector<Rgb> pixels;
    pixels.reserve(image.values.size() / 3);
    for (size_t i = 0; i < image.values.size(); i += 3)
        pixels.emplace_back(image.values[i], image.values[i + 1], image.values[i + 2]);
    return pixels;
}

std::string ErrorUri(const DenoisedImage& denoised) {
    std::vector<float> shares;
    for (const float error : denoised.error) shares.push_back(std::min(1.f, error / 2));
    return MapUri(shares, denoised.image.width, denoised.image.height);
}

}  // namespace

std::string Base64(std::span<const std::byte> bytes) {
    constexpr const char* kDigits =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    text.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t group = 0;
        for (size_t k = i; k < i + 3; ++k)
            group = group << 8 | (k < bytes.size() ? uint32_t(bytes[k]) : 0);
        for (int k = 0; k < 4; ++k)
            text += i + size_t(k) > bytes.size() ? '=' : kDigits[group >> (18 - 6 * k) & 63];
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

std::string PictureUri(const RgbImage& image) {
    const int scale = PagePictureScale(image.width, image.height);
    const RgbImage shown{Shrunk(image.width, scale), Shrunk(image.height, scale),
                         Shrink(image.values, image.width, image.height, 3, scale)};
    return Uri(PixelsOf(shown), shown.width, shown.height);
}

std::string MapUri(std::span<const float> values, int width, int height) {
    const int scale = PagePictureScale(width, height);
    std::vector<Rgb> pixels;
    for (const float value : Shrink(values, width, height, 1, scale))
        pixels.push_back(Viridis(value).unaryExpr([](float v) { return LinearFromSrgb(v); }));
    return Uri(pixels, Shrunk(width, scale), Shrunk(height, scale));
}

Json CurvesJson(const BlockCurves& curves) {
    return {{"spp", curves.spp}, {"entropy", curves.entropy}, {"noise", curves.noise}};
}

int PagePictureScale(int width, int height) {
    int scale = 1;
    while (int64_t(Shrunk(width, scale)) * Shrunk(height, scale) > kMostPagePixels) ++scale;
    return scale;
}

RgbImage PagePicture(const Film& film) {
    const PixelRect& region = film.Region();
    const int width = region.Width(), scale = PagePictureScale(width, region.Height());
    RgbImage picture{Shrunk(width, scale), Shrunk(region.Height(), scale), {}};
    picture.values.reserve(size_t(picture.width) * size_t(picture.height) * 3);
    FilmView view;
    for (int y = region.min.y(); y < region.max.y(); y += scale) {
        const int end = std::min(y + scale, region.max.y());
        film.Extract({{region.min.x(), y}, {region.max.x(), end}}, false, &view);
        std::ranges::copy(Shrink(view.mean, width, end - y, 3, scale),
                          std::back_inserter(picture.values));
    }
    return picture;
}

void NotePictureScale(int width, int height, Json* page) {
    if (const int scale = PagePictureScale(width, height); scale > 1)
        (*page)["notes"].push_back(fmt::format(
            "Pictures show the means of {0}x{0} pixels: whole ones would be too large for a page. "
            "All pixels are in the PNG and EXR files, and in all figures.",
            scale));
}

std::string MakeRenderPage(const Provenance& provenance, const RenderResult& result,
                           const Film& film, const std::vector<BlockHistory>& histories,
                           const std::map<std::string, int>& warnings,
                           const DenoisedImage* denoised) {
    Json page = ReportJson(provenance, result, film.RejectedCount(), warnings, denoised);
    const std::string samples = PictureUri(PagePicture(film));
    Json image = {{"name", "image"},
                  {"label", denoised ? "denoised image" : "image"},
                  {"rule", provenance.criterion},
                  {"src", denoised ? PictureUri(denoised->image) : samples},
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
    NotePictureScale(film.Region().Width(), film.Region().Height(), &page);
    page["kind"] = "render";
    page["title"] = SceneName(provenance.scene);
    page["cap"] = provenance.schedule.cap;
    page["width"] = film.Region().Width();
    page["height"] = film.Region().Height();
    if (const int width = provenance.schedule.eyeWidth; width > 0) page["eyeWidth"] = width;
    page["images"] = {std::move(image)};
    if (denoised) {
        page["images"].push_back(
            {{"name", "samples"}, {"label", "mean of the samples"}, {"src", samples}});
        page["images"].push_back({{"name", "error"},
                                  {"label", "estimated error (yellow: 2 L*)"},
                                  {"src", ErrorUri(*denoised)}});
    }
    return FillPage("page.html", {{"data", JsonForScript(page)},
                                  {"report.js", std::string(EmbeddedFile("render.js"))}});
}

}  // namespace lull
