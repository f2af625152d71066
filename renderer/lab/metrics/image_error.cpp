#include "renderer/lab/metrics/image_error.h"

#include <fmt/core.h>

#include "renderer/base/error.h"
#include "renderer/lab/metrics/flip.h"
#include "renderer/lab/metrics/ssim.h"
#include "stopping/signals/lightness.h"

namespace lull {

namespace {

double Finite(float v) { return std::isfinite(v) ? double(v) : 0; }

void AddLinearErrors(const RgbImage& image, const RgbImage& reference, ErrorMaps* maps) {
    for (size_t i = 0; i < image.values.size(); i += 3) {
        double squared = 0, relative = 0;
        for (size_t c = i; c < i + 3; ++c) {
            const double r = Finite(reference.values[c]);
            const double e = Sqr(Finite(image.values[c]) - r);
            squared += e / 3;
            relative += e / (3 * (r * r + 0.01));
        }
        maps->squared.push_back(float(squared));
        maps->relative.push_back(float(relative));
    }
}

// Returns the means over a rectangle of values that are not NaN, NaN where there are none.
double MeanOf(const std::vector<float>& map, int width, const PixelRect& rect) {
    double sum = 0;
    int64_t count = 0;
    for (int y = rect.min.y(); y < rect.max.y(); ++y)
        for (int x = rect.min.x(); x < rect.max.x(); ++x) {
            const float v = map[size_t(y) * width + x];
            if (std::isnan(v)) continue;
            sum += double(v);
            ++count;
        }
    return count > 0 ? sum / double(count) : std::numeric_limits<double>::quiet_NaN();
}

// Decodes 8-bit sRGB values.
std::vector<float> LinearValues(std::span<const uint8_t> srgb) {
    const std::array<double, 256>& linear = DecodeSrgb8();
    std::vector<float> values;
    values.reserve(srgb.size());
    for (const uint8_t v : srgb) values.push_back(float(linear[v]));
    return values;
}

}  // namespace

ErrorMaps CompareImages(const RgbImage& image, const RgbImage& reference,
                        const DisplayModel& display) {
    if (image.width != reference.width || image.height != reference.height)
        throw Error(fmt::format("an image of {}x{} pixels cannot be compared with one of {}x{}",
                                image.width, image.height, reference.width, reference.height));
    ErrorMaps maps;
    maps.width = image.width;
    maps.height = image.height;
    AddLinearErrors(image, reference, &maps);

    const size_t pixels = image.values.size() / 3;
    std::vector<uint8_t> a(3 * pixels), b(3 * pixels);
    EncodeSrgb8(image.values, a);
    EncodeSrgb8(reference.values, b);
    std::vector<double> lightnessA(pixels), lightnessB(pixels);
    Lightness(a, lightnessA);
    Lightness(b, lightnessB);
    for (size_t i = 0; i < pixels; ++i) {
        maps.lightness.push_back(float(Sqr(lightnessA[i] - lightnessB[i])));
        double squared = 0;
        for (size_t c = 3 * i; c < 3 * i + 3; ++c) squared += Sqr(double(a[c]) - double(b[c])) / 3;
        maps.display.push_back(float(squared));
    }
    maps.ssim = SsimMap(a, b, image.width, image.height);
    maps.flip = FlipMap(a, b, image.width, image.height, DefaultPixelsPerDegree());
    maps.visibleDifference =
        FindVisibleDifference(LinearValues(a), LinearValues(b), image.width, image.height, display);
    return maps;
}

ErrorFigures Average(const ErrorMaps& maps, const PixelRect& rect) {
    const auto mean = [&](const std::vector<float>& map) { return MeanOf(map, maps.width, rect); };
    return {.rmse = std::sqrt(mean(maps.squared)),
            .relMse = mean(maps.relative),
            .rmseLightness = std::sqrt(mean(maps.lightness)),
            .psnr = 10 * std::log10(Sqr(255.0) / mean(maps.display)),
            .ssim = mean(maps.ssim),
            .flip = mean(maps.flip),
            .visibleDifference = PooledDifference(maps.visibleDifference, rect)};
}

ErrorFigures Average(const ErrorMaps& maps) {
    return Average(maps, {{0, 0}, {maps.width, maps.height}});
}

}  // namespace lull
