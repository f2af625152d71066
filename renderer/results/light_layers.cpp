#include "renderer/results/light_layers.h"

#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>
#include <nlohmann/json.hpp>

namespace lull {

namespace {

using Sum = std::array<double, 3>;

// Calls visit(i, p) for every pixel p, the i-th row by row.
template <typename Visit>
void ForEachPixel(const PixelRect& region, const Visit& visit) {
    size_t i = 0;
    for (int y = region.min.y(); y < region.max.y(); ++y)
        for (int x = region.min.x(); x < region.max.x(); ++x) visit(i++, Vec2i(x, y));
}

// Returns the means of a group's samples; the first look of the film, where there are none, belongs
// to the last group.
std::vector<float> MeansOf(const LightGroupFilm& lights, int group, const Film& film) {
    std::vector<float> rgb(size_t(film.Region().Area()) * 3);
    ForEachPixel(film.Region(), [&](size_t i, const Vec2i& p) {
        const FilmPixel pixel = lights.At(group, p, film.At(p).count);
        const bool showsLook = pixel.count == 0 && group + 1 == lights.Count();
        const Rgb mean = showsLook ? film.MeanAt(p) : pixel.Mean();
        std::copy_n(mean.data(), 3, &rgb[3 * i]);
    });
    return rgb;
}

void LeaveOutBackground(const LightGroupFilm& lights, int group, const Film& film,
                        const MatteFilm& mattes, bool isDenoised, std::vector<float>* rgb) {
    ForEachPixel(film.Region(), [&](size_t i, const Vec2i& p) {
        const FilmPixel pixel = lights.At(group, p, film.At(p).count);
        const Sum& background = lights.BackgroundAt(group, p);
        for (size_t c = 0; c < 3 && pixel.count > 0; ++c)
            RemoveBackground(mattes.alpha.At(p).covered, pixel.sum[c] / pixel.count,
                             background[c] / pixel.count, isDenoised, &(*rgb)[3 * i + c]);
    });
}

// Returns the text in UTF-8, with U+FFFD in place of other bytes and of NUL.
std::string ReadableUtf8(const std::string& text) {
    using nlohmann::json;
    const std::string utf8 =
        json::parse(json(text).dump(-1, ' ', false, json::error_handler_t::replace));
    std::string clean;
    for (const char c : utf8) clean += c == '\0' ? std::string("\xef\xbf\xbd") : std::string(1, c);
    return clean;
}

// Returns the beginning of UTF-8 text, of up to `most` bytes, without part of a character.
std::string Beginning(const std::string& text, size_t most) {
    if (text.size() <= most) return text;
    while (most > 0 && (text[most] & 0xc0) == 0x80) --most;
    return text.substr(0, most);
}

// Returns names of layers that differ, in UTF-8: an EXR cuts those of channels off, silently.
std::vector<std::string> LayerNames(const std::vector<std::string>& groups) {
    constexpr size_t kLongest = 240;  // bytes; 255 with "light." and ".R"
    std::vector<std::string> names;
    for (const std::string& group : groups) {
        const std::string whole = ReadableUtf8(group);
        std::string name = whole;
        bool isLong = whole.size() > kLongest;
        for (int number = 1; isLong || std::ranges::count(names, name) > 0; ++number) {
            const std::string end = "~" + std::to_string(number);
            name = Beginning(whole, kLongest - end.size()) + end;
            isLong = false;
        }
        names.push_back(name);
    }
    return names;
}

}  // namespace

void AddLightLayers(const LightGroupFilm& lights, const Film& film, const DenoisedImage* denoised,
                    const MatteFilm* mattes, ExtraLayers* extra) {
    const std::vector<std::string> names = LayerNames(lights.Groups().names);
    extra->attributes["lightGroups"] = fmt::format("{}", fmt::join(names, ","));
    if (mattes && denoised) extra->colours.resize(size_t(film.Region().Area()) * 3);
    for (int group = 0; group < lights.Count(); ++group) {
        std::vector<float> rgb =
            denoised ? denoised->lights[size_t(group)] : MeansOf(lights, group, film);
        if (mattes) LeaveOutBackground(lights, group, film, *mattes, denoised != nullptr, &rgb);
        std::ranges::transform(extra->colours, rgb, extra->colours.begin(), std::plus());
        std::ranges::move(ColourChannels("light." + names[size_t(group)] + ".", rgb),
                          std::back_inserter(extra->channels));
    }
}

}  // namespace lull
