#include "renderer/denoise/visible_error.h"

#include <algorithm>

#include "renderer/denoise/displayed_lightness.h"
#include "renderer/denoise/missing_detail.h"
#include "renderer/denoise/tile.h"
#include "renderer/vision/visible_difference.h"

namespace lull {

namespace {

// Returns the detail that a block lacks, in lightness, where its error is `ratio` times half the
// difference of the halves.
Planes MissingIn(const Halves& halves, const Halves& noisy, std::span<const float> slope,
                 float ratio) {
    const Planes& size = noisy.a;
    CrossedResiduals crossed;
    for (Planes* p : {&crossed.a, &crossed.b, &crossed.noise, &crossed.half})
        *p = Planes(size.width, size.height, 1);
    for (size_t i = 0; i < size.Area(); ++i) {
        const auto lightness = [&](float luminance) {
            return std::clamp(slope[i] * luminance, -kLargest, kLargest);
        };
        const float a = LuminanceOf(halves.a, i), b = LuminanceOf(halves.b, i);
        const float noisyA = noisy.a.values[i], noisyB = noisy.b.values[i];
        crossed.a.values[i] = lightness(a - noisyB);
        crossed.b.values[i] = lightness(b - noisyA);
        crossed.noise.values[i] = lightness(noisyA - noisyB);
        crossed.half.values[i] = lightness((a - b) / 2);
    }
    return MissingDetail(crossed, ratio);
}

}  // namespace

VisibleError MeasureVisibleError(const DenoisedPicture& denoised, const EstimatedError& error,
                                 const PixelRect& block, const DisplayModel& display) {
    const LightnessError lightness = MeasureLightnessError(error, block);
    const ImageTile tile{block.min.x(), block.min.y(), block.max.x(), block.max.y()};
    const Planes picture = Crop(denoised.picture, tile), structure = Crop(error.structure, tile);
    const Planes returned = Crop(denoised.returned, tile);
    const Halves halves{Crop(denoised.halves.a, tile), Crop(denoised.halves.b, tile)};
    const Halves noisy{Crop(error.noisy.a, tile), Crop(error.noisy.b, tile)};
    std::vector<float> slope, sure;  // of lightness by luminance; share of the luminance
    for (size_t i = 0; i < picture.Area(); ++i) {
        const float y = LuminanceOf(picture, i);
        slope.push_back(DisplayedLightness(y).slope);
        sure.push_back(y > 0 ? std::max(0.f, 1 - returned.values[i] / y) : 1);
    }
    const VisibleReference reference =
        PrepareReference(Interleaved(picture), block.Width(), block.Height(), display);
    const auto ratioOf = [&](double magnitude) {
        return lightness.least > 0 ? float(magnitude / lightness.least) : 1;
    };
    // Adds to the picture the pattern of the halves' difference, and lightness that it lacks.
    const auto difference = [&](float ratio, const Planes& missing) {
        Planes other = picture;
        for (size_t i = 0; i < picture.Area(); ++i) {
            const float lacks = structure.values[i] + missing.values[i];
            const float luminance = slope[i] > 0 ? lacks / slope[i] : 0;
            for (int c = 0; c < kColours; ++c)
                other.Plane(c)[i] = sure[i] * picture.Plane(c)[i] +
                                    ratio * ((halves.a.Plane(c)[i] - halves.b.Plane(c)[i]) / 2) +
                                    luminance;
        }
        return PooledDifference(FindVisibleDifference(Interleaved(other), reference));
    };
    VisibleError result;
    const float estimate = ratioOf(lightness.estimate), upper = ratioOf(lightness.upper);
    result.estimate = difference(estimate, Planes(block.Width(), block.Height(), 1));
    result.upper =
        std::max(result.estimate, difference(upper, MissingIn(halves, noisy, slope, upper)));
    return result;
}

}  // namespace lull
