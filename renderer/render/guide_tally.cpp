#include "renderer/render/guide_tally.h"

#include "renderer/base/color.h"

namespace lull {

namespace {

// Returns the derivative of CIE lightness L* by luminance; 0 beyond white.
double SlopeUpToWhite(double y) {
    constexpr double kLinear = 0.008856, kSlope = 903.3;
    return y > 1 ? 0 : y > kLinear ? 116. / 3 * std::pow(y, -2. / 3) : kSlope;
}

// Returns the mean luminance of each tile.
std::vector<double> LuminanceOf(const Film& film) {
    std::vector<double> luminance(film.TileCount()), pixels(luminance.size());
    const PixelRect& region = film.Region();
    for (int y = region.min.y(); y < region.max.y(); ++y)
        for (int x = region.min.x(); x < region.max.x(); ++x) {
            const size_t tile = film.TileAt({x, y});
            luminance[tile] += double(Luminance(film.At({x, y}).Mean()));
            ++pixels[tile];
        }
    for (size_t i = 0; i < luminance.size(); ++i) luminance[i] /= std::max(1., pixels[i]);
    return luminance;
}

}  // namespace

GuideComparison GuideTally::Compare(const Film& film) const {
    struct Noise {
        double unguided, guided;
    };
    std::vector<Noise> noise;
    Noise sum{0, 0}, vertices{0, 0};
    const std::vector<double> luminance = LuminanceOf(film);
    for (size_t i = 0; i < unguided.size() && i < guided.size(); ++i) {
        const SampleSpread &a = unguided[i], &b = guided[i];
        if (a.freedom <= 0 || b.freedom <= 0) continue;
        vertices.unguided += double(a.vertices) / double(a.samples);
        vertices.guided += double(b.vertices) / double(b.samples);
        const double slope = SlopeUpToWhite(luminance[i]);
        const Noise both{slope * std::sqrt(a.squares / double(a.freedom)),
                         slope * std::sqrt(b.squares / double(b.freedom))};
        if (!(both.unguided + both.guided < INFINITY)) continue;
        noise.push_back(both);
        sum.unguided += both.unguided;
        sum.guided += both.guided;
    }
    GuideComparison comparison;
    if (vertices.unguided > 0) comparison.vertices = vertices.guided / vertices.unguided;
    if (noise.size() < 2 || !(sum.unguided > 0)) return comparison;
    // The error of a ratio of means, to first order (Cochran 1977, eq. 2.39).
    const double ratio = sum.guided / sum.unguided, count = double(noise.size());
    double squares = 0;
    for (const Noise& tile : noise) squares += Sqr(tile.guided - ratio * tile.unguided);
    comparison.variance = ratio * ratio;
    comparison.error = 2 * ratio * std::sqrt(squares * count / (count - 1)) / sum.unguided;
    return comparison;
}

}  // namespace lull
