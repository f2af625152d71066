#include "renderer/denoise/denoiser.h"

namespace lull {

DenoiserResult RunDenoiser(NoisyPicture picture, std::span<const PictureBlock> blocks,
                           const DenoiserOptions& options) {
    DenoisedPicture denoised = Denoise(std::move(picture), options.isQuick ? 2 : 1);
    DenoiserResult result;
    const EstimatedError error = MeasureError(denoised);
    if (options.withDeviation) result.deviation = StandardError(denoised, error.structure).values;
    denoised.halves = denoised.noisy = {};  // a large picture needs the memory, here and below
    result.rgb = Interleaved(denoised.picture);
    denoised = {};
    for (const auto& [x0, y0, x1, y1] : blocks) {
        const bool isSmall = std::min(x1 - x0, y1 - y0) < kSmallestMeasuredSide;
        result.blocks.emplace_back();
        if (!isSmall) result.blocks.back() = MeasureVisibleError(error, x0, y0, x1, y1);
    }
    return result;
}

}  // namespace lull
