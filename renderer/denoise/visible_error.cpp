#include "renderer/denoise/visible_error.h"

#include <algorithm>

#include "renderer/denoise/displayed_lightness.h"
#include "renderer/vision/visible_difference.h"

namespace lull {

namespace {

// Calls use(i, j) for each pixel of a block: i in the picture, j in the block, row by row.
template <typename Use>
void ForEachPixel(const PixelRect& block, int width, const Use& use) {
    size_t j = 0;
    for (int y = block.min.y(); y < block.max.y(); ++y)
        for (int x = block.min.x(); x < block.max.x(); ++x)
            use(size_t(y) * size_t(width) + size_t(x), j++);
}

// R, G, B of each pixel of a block.
struct BlockPicture {
    std::vector<float> picture, change, structure;
};

BlockPicture Cut(const DenoisedPicture& denoised, const Planes& structure, const PixelRect& block) {
    const size_t size = size_t(kColours) * size_t(block.Area());
    BlockPicture cut{std::vector<float>(size), std::vector<float>(size), std::vector<float>(size)};
    ForEachPixel(block, structure.width, [&](size_t i, size_t j) {
        const float slope = DisplayedLightness(LuminanceOf(denoised.picture, i)).slope;
        for (int c = 0; c < kColours; ++c) {
            const size_t k = size_t(kColours) * j + size_t(c);
            cut.picture[k] = denoised.picture.Plane(c)[i];
            cut.change[k] = (denoised.halves.a.Plane(c)[i] - denoised.halves.b.Plane(c)[i]) / 2;
            cut.structure[k] = slope > 0 ? structure.values[i] / slope : 0;
        }
    });
    return cut;
}

}  // namespace

VisibleError MeasureVisibleError(const DenoisedPicture& denoised, const EstimatedError& error,
                                 const PixelRect& block, const DisplayModel& display) {
    const LightnessError lightness = MeasureLightnessError(error, block);
    const BlockPicture cut = Cut(denoised, error.structure, block);
    const VisibleReference reference =
        PrepareReference(cut.picture, block.Width(), block.Height(), display);
    const auto difference = [&](double magnitude) {
        const float ratio = lightness.least > 0 ? float(magnitude / lightness.least) : 1;
        std::vector<float> other = cut.picture;
        for (size_t k = 0; k < other.size(); ++k)
            other[k] += ratio * cut.change[k] + cut.structure[k];
        return PooledDifference(FindVisibleDifference(other, reference));
    };
    VisibleError result;
    result.estimate = difference(lightness.estimate);
    result.upper = std::max(result.estimate, difference(lightness.upper));
    return result;
}

}  // namespace lull
