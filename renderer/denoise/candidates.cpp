#include "renderer/denoise/candidates.h"

#include <cmath>

namespace lull {

namespace {

constexpr int kColours = 3;
constexpr int kErrorRadius = 4, kChoiceRadius = 4;  // pixels over which both are smoothed
constexpr float kDarkest = 1e-3f;     // squared luminance below which errors are no longer relative
constexpr float kLeastNoise = 1e-4f;  // relative variance, squared, below which pixels count alike
constexpr float kDoubt = 2;           // standard deviations

// Holds what all candidates' errors are measured with.
struct Measure {
    Planes scale;    // of squared errors, to make them relative
    Planes weight;   // of pixels
    Planes weights;  // its sum around
};

Planes SumAround(Planes image) { return BoxSum(std::move(image), kErrorRadius); }

float LuminanceOf(const Halves& halves, size_t i) {
    const auto y = [&](const Planes& p) {
        return 0.212671f * p.Plane(0)[i] + 0.715160f * p.Plane(1)[i] + 0.072169f * p.Plane(2)[i];
    };
    return (y(halves.a) + y(halves.b)) / 2;
}

float SumOfColours(const Planes& image, size_t i) {
    return image.Plane(0)[i] + image.Plane(1)[i] + image.Plane(2)[i];
}

Measure MakeMeasure(const Halves& smooth, const Planes& variance) {
    Measure measure{Planes(variance.width, variance.height, 1), {}, {}};
    measure.weight = measure.scale;
    for (size_t i = 0; i < measure.scale.Area(); ++i) {
        const float y = LuminanceOf(smooth, i);
        measure.scale.values[i] = 1 / (kDarkest + y * y);
        const float noise = SumOfColours(variance, i) * measure.scale.values[i];
        measure.weight.values[i] = 1 / (noise * noise + kLeastNoise);
    }
    measure.weights = SumAround(measure.weight);
    return measure;
}

// Estimates the squared error of the mean of both halves.
Planes ErrorOf(const Halves& candidate, const Halves& noisy, const Measure& measure) {
    const auto square = [](float x) { return x * x; };
    Planes error(noisy.a.width, noisy.a.height, 1);
    for (size_t i = 0; i < error.Area(); ++i) {
        float sum = 0;
        for (int c = 0; c < kColours; ++c) {
            const float a = noisy.a.Plane(c)[i], b = noisy.b.Plane(c)[i];
            const float x = candidate.a.Plane(c)[i], y = candidate.b.Plane(c)[i];
            sum += (square(x - b) + square(y - a) - square(a - b)) / 2 - square(x - y) / 4;
        }
        error.values[i] = sum * measure.scale.values[i] * measure.weight.values[i];
    }
    error = SumAround(std::move(error));
    for (size_t i = 0; i < error.Area(); ++i) error.values[i] /= measure.weights.values[i];
    return error;
}

// Returns the squared error of the samples, which is their variance, and what the errors of others
// may be above the truth by chance.
Planes ErrorOfNoise(const Planes& variance, const Measure& measure) {
    Planes error(variance.width, variance.height, 1), doubt = error;
    for (size_t i = 0; i < error.Area(); ++i) {
        const float noise = SumOfColours(variance, i) * measure.scale.values[i];
        const float weighted = noise * measure.weight.values[i];
        error.values[i] = noise / 2;
        doubt.values[i] = weighted * weighted / 2;
    }
    error = BoxMean(std::move(error), kErrorRadius);
    doubt = SumAround(std::move(doubt));
    for (size_t i = 0; i < error.Area(); ++i)
        error.values[i] += kDoubt * std::sqrt(doubt.values[i]) / measure.weights.values[i];
    return error;
}

}  // namespace

Halves ChooseCandidates(std::vector<Halves> candidates, const Halves& noisy,
                        const Planes& variance) {
    const int width = variance.width, height = variance.height;
    const Measure measure = MakeMeasure(candidates.back(), variance);
    std::vector<Planes> errors;
    for (const Halves& candidate : candidates) errors.push_back(ErrorOf(candidate, noisy, measure));
    errors.push_back(ErrorOfNoise(variance, measure));
    candidates.push_back(noisy);

    std::vector<Planes> shares(candidates.size(), Planes(width, height, 1));
    for (size_t i = 0; i < variance.Area(); ++i) {
        size_t best = 0;
        for (size_t k = 1; k < candidates.size(); ++k)
            if (errors[k].values[i] < errors[best].values[i]) best = k;
        shares[best].values[i] = 1;
    }
    Halves result{Planes(width, height, kColours), Planes(width, height, kColours)};
    for (size_t k = 0; k < candidates.size(); ++k) {
        const Planes share = BoxMean(std::move(shares[k]), kChoiceRadius);
        for (int c = 0; c < kColours; ++c)
            for (size_t i = 0; i < share.Area(); ++i) {
                result.a.Plane(c)[i] += candidates[k].a.Plane(c)[i] * share.values[i];
                result.b.Plane(c)[i] += candidates[k].b.Plane(c)[i] * share.values[i];
            }
    }
    return result;
}

}  // namespace lull
