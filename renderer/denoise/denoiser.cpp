#include "renderer/denoise/denoiser.h"

#include <tbb/task_arena.h>

#include "stopping/base/parallel.h"

namespace lull {

namespace {

using Blocks = std::vector<std::optional<VisibleError>>;

// Measures the error of a denoised picture, whose memory it uses.
DenoiserResult Measured(DenoisedPicture denoised, std::span<const PixelRect> blocks,
                        const DenoiserOptions& options) {
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

int RowsPerFit(const DenoiserOptions& options) { return options.isQuick ? 2 : 1; }

void Add(const Planes& image, Planes* sum) {
    if (sum->count == 0) *sum = Planes(image.width, image.height, image.count);
    for (size_t i = 0; i < sum->values.size(); ++i) sum->values[i] += Sane(image.values[i]);
}

void Add(const Halves& halves, Halves* sum) {
    Add(halves.a, &sum->a);
    Add(halves.b, &sum->b);
}

// Replaces the errors of blocks by larger ones of the same blocks.
void Raise(const Blocks& errors, Blocks* blocks) {
    for (size_t i = 0; i < blocks->size(); ++i) {
        if (!errors[i]) continue;
        VisibleError& error = (*blocks)[i].value();
        error.estimate = std::max(error.estimate, errors[i]->estimate);
        error.upper = std::max(error.upper, errors[i]->upper);
    }
}

}  // namespace

DenoiserResult RunDenoiser(NoisyPicture picture, std::span<const PixelRect> blocks,
                           const DenoiserOptions& options) {
    return Measured(Denoise(std::move(picture), RowsPerFit(options)), blocks, options);
}

GroupedResult RunDenoiser(GroupedPicture picture, std::span<const PixelRect> blocks,
                          const DenoiserOptions& options) {
    GroupedResult result;
    std::vector<Blocks> errors;
    DenoisedPicture sum;
    Halves colour;
    for (int i = 0; i < picture.groups; ++i) {
        NoisyPicture light = picture.light(i);
        Add(light.colour, &colour);
        const bool isLast = i + 1 == picture.groups;
        light.features = isLast ? std::move(picture.features) : picture.features;
        DenoisedPicture denoised = Denoise(std::move(light), RowsPerFit(options));
        Add(denoised.picture, &sum.picture);
        Add(denoised.halves, &sum.halves);
        Add(denoised.noisy, &sum.noisy);
        Add(denoised.returned, &sum.returned);
        DenoiserResult own = Measured(std::move(denoised), blocks, {.withDeviation = false});
        result.groups.push_back(std::move(own.rgb));
        errors.push_back(std::move(own.blocks));
    }
    // The light of groups is not independent: a sample of one lamp is none of another.
    sum.variance = EstimateVariance(colour, picture.variance);
    colour = {};
    result.sum = Measured(std::move(sum), blocks, options);
    for (const Blocks& group : errors) Raise(group, &result.sum.blocks);
    return result;
}

}  // namespace lull
