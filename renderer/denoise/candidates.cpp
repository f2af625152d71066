#include "renderer/denoise/candidates.h"

#include <cmath>

namespace lull {

namespace {

constexpr int kErrorRadius = 4, kChoiceRadius = 4;  // pixels over which both are smoothed
constexpr float kDarkest = 1e-3f;     // squared luminance below which errors are no longer relative
constexpr float kLeastNoise = 1e-4f;  // relative variance, squared, below which pixels count alike
constexpr float kDoubt = 2;           // standard deviations

// Holds what all candidates' errors are measured with.
struct ErrorScale {
    Planes ofSquares;  // makes squared errors relative
    Planes weight;     // of pixels
    Planes weights;    // its sum around
};

Planes SumAround(Planes image) { return BoxSum(std::move(image), kErrorRadius); }

float SumOfColours(const Planes& image, size_t i) {
    return image.Plane(0)[i] + image.Plane(1)[i] + image.Plane(2)[i];
}

ErrorScale MakeErrorScale(const Halves& smooth, const Planes& variance) {
    ErrorScale scale{Planes(variance.width, variance.height, 1), {}, {}};
    scale.weight = scale.ofSquares;
    for (size_t i = 0; i < scale.ofSquares.Area(); ++i) {
        const float y = (LuminanceOf(smooth.a, i) + LuminanceOf(smooth.b, i)) / 2;
        scale.ofSquares.values[i] = 1 / (kDarkest + y * y);
        const float noise = SumOfColours(variance, i) * scale.ofSquares.values[i];
        scale.weight.values[i] = 1 / (noise * noise + kLeastNoise);
    }
    scale.weights = SumAround(scale.weight);
    return scale;
}

// Estimates the squared error of the mean of both halves.
Planes ErrorOf(const Halves& candidate, const Halves& noisy, const ErrorScale& scale) {
    const auto square = [](float x) { return x * x; };
    Planes error(noisy.a.width, noisy.a.height, 1);
    for (size_t i = 0; i < error.Area(); ++i) {
        float sum = 0;
        for (int c = 0; c < kColours; ++c) {
            const float a = noisy.a.Plane(c)[i], b = noisy.b.Plane(c)[i];
            const float x = candidate.a.Plane(c)[i], y = candidate.b.Plane(c)[i];
            sum += (square(x - b) + square(y - a) - square(a - b)) / 2 - square(x - y) / 4;
        }
        error.values[i] = sum * scale.ofSquares.values[i] * scale.weight.values[i];
    }
    error = SumAround(std::move(error));
    for (size_t i = 0; i < error.Area(); ++i) error.values[i] /= scale.weights.values[i];
    return error;
}

// Returns the squared error of the samples, which is their variance, and what the errors of others
// may be above the truth by chance.
Planes ErrorOfNoise(const Planes& variance, const ErrorScale& scale) {
    Planes error(variance.width, variance.height, 1), doubt = error;
    for (size_t i = 0; i < error.Area(); ++i) {
        const float noise = SumOfColours(variance, i) * scale.ofSquares.values[i];
        const float weighted = noise * scale.weight.values[i];
        error.values[i] = noise / 2;
        doubt.values[i] = weighted * weighted / 2;
    }
    error = BoxMean(std::move(error), kErrorRadius);
    doubt = SumAround(std::move(doubt));
    for (size_t i = 0; i < error.Area(); ++i)
        error.values[i] += kDoubt * std::sqrt(doubt.values[i]) / scale.weights.values[i];
    return error;
}

}  // namespace

Halves ChooseCandidates(std::vector<Halves> candidates, const Halves& noisy,
                        const Planes& variance) {
    const int width = variance.width, height = variance.height;
    const ErrorScale scale = MakeErrorScale(candidates.back(), variance);
    std::vector<Planes> errors;
    for (const Halves& candidate : candidates) errors.push_back(ErrorOf(candidate, noisy, scale));
    errors.push_back(ErrorOfNoise(variance, scale));
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
