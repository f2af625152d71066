#include "renderer/denoise/denoiser.h"

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace lull {

DenoiserResult RunDenoiser(NoisyPicture picture, std::span<const PixelRect> blocks,
                           const DenoiserOptions& options) {
    DenoisedPicture denoised = Denoise(std::move(picture), options.isQuick ? 2 : 1);
    DenoiserResult result;
    const EstimatedError error = MeasureError(denoised);
    if (options.withDeviation) result.deviation = StandardError(denoised, error.structure).values;
    denoised.noisy = {};  // a large picture needs the memory
    result.blocks.resize(blocks.size());
    tbb::this_task_arena::isolate([&] {
        tbb::parallel_for(size_t(0), blocks.size(), [&](size_t i) {
            if (std::min(blocks[i].Width(), blocks[i].Height()) >= kSmallestMeasuredSide)
                result.blocks[i] = MeasureVisibleError(denoised, error, blocks[i]);
        });
    });
    denoised.halves = {};
    result.rgb = Interleaved(denoised.picture);
    return result;
}

}  // namespace lull
