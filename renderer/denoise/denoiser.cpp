#include "renderer/denoise/denoiser.h"

#include <tbb/task_arena.h>

#include "stopping/base/parallel.h"

namespace lull {

namespace {

using Blocks = std::vector<std::optional<VisibleError>>;

void Add(const Planes& image, Planes* sum) {
    if (sum->count == 0) *sum = Planes(image.width, image.height, image.count);
    for (size_t i = 0; i < sum->values.size(); ++i) sum->values[i] += Sane(image.values[i]);
}

void Add(const Halves& halves, Halves* sum) {
    Add(halves.a, &sum->a);
    Add(halves.b, &sum->b);
}

void Raise(const Blocks& errors, Blocks* blocks) {
    for (size_t i = 0; i < blocks->size(); ++i) {
        if (!errors[i]) continue;
        VisibleError& error = (*blocks)[i].value();
        error.estimate = std::max(error.estimate, errors[i]->estimate);
        error.upper = std::max(error.upper, errors[i]->upper);
        error.worstPixels = std::max(error.worstPixels, errors[i]->worstPixels);
        error.worst = std::max(error.worst, errors[i]->worst);
    }
}

// A denoised picture as it is shown, made part by part: a graded copy would take much memory.
struct ShownPicture {
    const DenoisedPicture& linear;
    const Grading& grading;  // null: the same

    int Width() const { return linear.picture.width; }
    int Height() const { return linear.picture.height; }
    DenoisedPicture In(const ImageTile& tile) const {
        return grading ? Graded(Crop(linear, tile), grading) : Crop(linear, tile);
    }
    // Calls use(shown, crop, rows) for some rows after the other, cut out with this margin.
    template <typename Use>
    void ForEachRows(int margin, const Use& use) const {
        for (int y = 0; y < Height(); y += kRows) {
            const ImageTile rows{0, y, Width(), std::min(y + kRows, Height())};
            const ImageTile crop = rows.Grown(margin).Within(Width(), Height());
            use(In(crop), crop, rows);
        }
    }

    static constexpr int kRows = 232;  // with margins not more than BandRows() takes at once
};

Planes StructureLeft(const ShownPicture& picture) {
    const DenoisedPicture& linear = picture.linear;
    if (!picture.grading) return StructureLeft(linear.noisy, linear.variance, linear.halves);
    Planes left(picture.Width(), picture.Height(), 1);
    picture.ForEachRows(kStructureReach, [&](const DenoisedPicture& shown, const ImageTile& crop,
                                             const ImageTile& rows) {
        Paste(StructureLeft(shown.noisy, shown.variance, shown.halves), rows.In(crop), rows.x0,
              rows.y0, &left);
    });
    return left;
}

std::vector<float> DeviationOf(const ShownPicture& picture, const Planes& structure) {
    std::vector<float> deviation;
    deviation.reserve(structure.Area());
    picture.ForEachRows(kErrorReach, [&](const DenoisedPicture& shown, const ImageTile& crop,
                                         const ImageTile& rows) {
        const Planes made = StandardError(shown, Crop(structure, crop));
        const ImageTile part = rows.In(crop);
        deviation.insert(deviation.end(), made.Row(0, part.y0), made.Row(0, part.y1));
    });
    return deviation;
}

VisibleError ErrorIn(const ShownPicture& picture, const Planes& structure, const PixelRect& block) {
    const ImageTile tile{block.min.x(), block.min.y(), block.max.x(), block.max.y()};
    const ImageTile crop = tile.Grown(kErrorReach).Within(picture.Width(), picture.Height());
    const DenoisedPicture shown = picture.In(crop);
    const ImageTile part = tile.In(crop);
    return MeasureVisibleError(shown, MeasureError(shown, Crop(structure, crop)),
                               {{part.x0, part.y0}, {part.x1, part.y1}});
}

// Measures the error of a picture as it is shown. Returns the standard errors of pixels, if wanted.
std::vector<float> MeasureShown(const ShownPicture& picture, std::span<const PixelRect> places,
                                bool withDeviation, Blocks* blocks) {
    if (places.empty() && !withDeviation) return {};
    const Planes structure = StructureLeft(picture);
    blocks->resize(places.size());
    tbb::this_task_arena::isolate([&] {
        ForEachIndex(int(places.size()), [&](int i) {
            const PixelRect& place = places[size_t(i)];
            if (std::min(place.Width(), place.Height()) >= kSmallestMeasuredSide)
                (*blocks)[size_t(i)] = ErrorIn(picture, structure, place);
        });
    });
    return withDeviation ? DeviationOf(picture, structure) : std::vector<float>();
}

DenoisedImage Measured(DenoisedPicture denoised, std::span<const PixelRect> places,
                       const DenoiserOptions& options) {
    DenoisedImage result;
    const std::vector<Grading> plain(1);
    const std::vector<Grading>& gradings = options.gradings.empty() ? plain : options.gradings;
    for (size_t i = 0; i < gradings.size(); ++i) {
        const bool isFirst = i == 0;
        Blocks errors;
        std::vector<float> deviation = MeasureShown({denoised, gradings[i]}, places,
                                                    isFirst && options.withDeviation, &errors);
        if (isFirst) {
            result.error = std::move(deviation);
            result.blocks = std::move(errors);
        } else {
            Raise(errors, &result.blocks);
        }
    }
    denoised.noisy = denoised.halves = {};
    denoised.variance = {};
    result.image = {denoised.picture.width, denoised.picture.height, Interleaved(denoised.picture)};
    return result;
}

}  // namespace

DenoisedImage RunDenoiser(NoisyPicture picture, std::span<const PixelRect> blocks,
                          const DenoiserOptions& options) {
    return Measured(Denoise(std::move(picture), options.effort, options.onShare), blocks, options);
}

DenoisedImage RunDenoiser(GroupedPicture picture, std::span<const PixelRect> blocks,
                          const DenoiserOptions& options) {
    std::vector<std::vector<float>> groups;
    std::vector<Blocks> errors;
    DenoisedPicture sum;
    for (int i = 0; i < picture.groups; ++i) {
        NoisyPicture light = picture.light(i);
        const bool isLast = i + 1 == picture.groups;
        light.features = isLast ? std::move(picture.features) : picture.features;
        const auto onShare = [&](double share) {
            if (options.onShare) options.onShare((i + share) / picture.groups);
        };
        DenoisedPicture denoised = Denoise(std::move(light), options.effort, onShare);
        Add(denoised.picture, &sum.picture);
        Add(denoised.halves, &sum.halves);
        Add(denoised.noisy, &sum.noisy);
        Add(denoised.returned, &sum.returned);
        std::ranges::copy(denoised.fireflies, std::back_inserter(sum.fireflies));
        DenoisedImage own = Measured(std::move(denoised), blocks,
                                     {.withDeviation = false, .gradings = options.gradings});
        groups.push_back(std::move(own.image.values));
        errors.push_back(std::move(own.blocks));
    }
    // The light of groups is not independent: a sample of one lamp is none of another.
    ForgetFireflies(sum.fireflies, sum.noisy, &picture.variance);
    sum.variance = EstimateVariance(sum.noisy, picture.variance);
    DenoisedImage result = Measured(std::move(sum), blocks, options);
    result.groups = std::move(groups);
    for (const Blocks& group : errors) Raise(group, &result.blocks);
    return result;
}

}  // namespace lull
