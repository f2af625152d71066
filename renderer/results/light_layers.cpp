#include "renderer/results/light_layers.h"

#include <algorithm>
#include <iterator>

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

}  // namespace

void AddLightLayers(const LightGroupFilm& lights, const Film& film, const DenoisedImage* denoised,
                    const MatteFilm* mattes, ExtraLayers* extra) {
    extra->attributes["lightGroups"] = NameOf(lights.Groups());
    if (mattes && denoised) extra->colours.resize(size_t(film.Region().Area()) * 3);
    for (int group = 0; group < lights.Count(); ++group) {
        std::vector<float> rgb =
            denoised ? denoised->lights[size_t(group)] : MeansOf(lights, group, film);
        if (mattes) LeaveOutBackground(lights, group, film, *mattes, denoised != nullptr, &rgb);
        std::ranges::transform(extra->colours, rgb, extra->colours.begin(), std::plus());
        std::ranges::move(
            ColourChannels("light." + lights.Groups().names[size_t(group)] + ".", rgb),
            std::back_inserter(extra->channels));
    }
}

}  // namespace lull
