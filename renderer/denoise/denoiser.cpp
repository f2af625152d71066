#include "renderer/denoise/denoiser.h"

#include <tbb/task_arena.h>

#include "stopping/base/parallel.h"

namespace lull {

namespace {

using Blocks = std::vector<std::optional<VisibleError>>;

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

// Measures the error of a picture as it is shown, without `noisy` in the end: a large one needs the
// memory. Returns the standard errors of pixels, where they are wanted.
std::vector<float> MeasureShown(DenoisedPicture* shown, std::span<const PixelRect> places,
                                bool withDeviation, Blocks* blocks) {
    std::vector<float> deviation;
    const EstimatedError error = MeasureError(*shown);
    if (withDeviation) deviation = StandardError(*shown, error.structure).values;
    shown->noisy = {};
    blocks->resize(places.size());
    tbb::this_task_arena::isolate([&] {
        ForEachIndex(int(places.size()), [&](int i) {
            const PixelRect& place = places[size_t(i)];
            if (std::min(place.Width(), place.Height()) >= kSmallestMeasuredSide)
                (*blocks)[size_t(i)] = MeasureVisibleError(*shown, error, place);
        });
    });
    return deviation;
}

// Measures the error of a denoised picture, whose memory it uses.
DenoiserResult Measured(DenoisedPicture denoised, std::span<const PixelRect> places,
                        const DenoiserOptions& options) {
    DenoiserResult result;
    const bool isPlain = options.gradings.empty();
    if (isPlain)
        result.deviation = MeasureShown(&denoised, places, options.withDeviation, &result.blocks);
    for (size_t i = 0; i < options.gradings.size(); ++i) {
        DenoisedPicture shown = Graded(denoised, options.gradings[i]);
        if (i == 0) {
            result.deviation = MeasureShown(&shown, places, options.withDeviation, &result.blocks);
            continue;
        }
        Blocks errors;
        MeasureShown(&shown, places, false, &errors);
        Raise(errors, &result.blocks);
    }
    denoised.noisy = denoised.halves = {};
    result.rgb = Interleaved(denoised.picture);
    return result;
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
        DenoiserResult own = Measured(std::move(denoised), blocks,
                                      {.withDeviation = false, .gradings = options.gradings});
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
