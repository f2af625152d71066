#include "renderer/denoise/visible_error.h"

#include <algorithm>

#include "renderer/denoise/displayed_lightness.h"
#include "renderer/denoise/tile.h"
#include "renderer/vision/visible_difference.h"

namespace lull {

VisibleError MeasureVisibleError(const DenoisedPicture& denoised, const EstimatedError& error,
                                 const PixelRect& block, const DisplayModel& display) {
    const LightnessError lightness = MeasureLightnessError(error, block);
    const ImageTile tile{block.min.x(), block.min.y(), block.max.x(), block.max.y()};
    const Planes picture = Crop(denoised.picture, tile), structure = Crop(error.structure, tile);
    const Halves halves{Crop(denoised.halves.a, tile), Crop(denoised.halves.b, tile)};
    const VisibleReference reference =
        PrepareReference(Interleaved(picture), block.Width(), block.Height(), display);
    const auto difference = [&](double magnitude) {
        const float ratio = lightness.least > 0 ? float(magnitude / lightness.least) : 1;
        Planes other = picture;
        for (size_t i = 0; i < picture.Area(); ++i) {
            const float slope = DisplayedLightness(LuminanceOf(picture, i)).slope;
            const float missing = slope > 0 ? structure.values[i] / slope : 0;
            for (int c = 0; c < kColours; ++c)
                other.Plane(c)[i] +=
                    ratio * ((halves.a.Plane(c)[i] - halves.b.Plane(c)[i]) / 2) + missing;
        }
        return PooledDifference(FindVisibleDifference(Interleaved(other), reference));
    };
    VisibleError result;
    result.estimate = difference(lightness.estimate);
    result.upper = std::max(result.estimate, difference(lightness.upper));
    return result;
}

}  // namespace lull
