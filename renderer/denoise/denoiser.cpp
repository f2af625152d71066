#include "renderer/denoise/denoiser.h"

#include <tbb/task_arena.h>

#include "stopping/base/parallel.h"

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
        ForEachIndex(int(blocks.size()), [&](int i) {
            const PixelRect& block = blocks[size_t(i)];
            if (std::min(block.Width(), block.Height()) >= kSmallestMeasuredSide)
                result.blocks[size_t(i)] = MeasureVisibleError(denoised, error, block);
        });
    });
    denoised.halves = {};
    result.rgb = Interleaved(denoised.picture);
    return result;
}

}  // namespace lull
