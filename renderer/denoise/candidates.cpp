#include "renderer/denoise/candidates.h"

#include <cmath>

namespace lull {

namespace {

constexpr int kErrorRadius = 5, kChoiceRadius = 6;  // pixels over which both are smoothed
static_assert(kErrorRadius + kChoiceRadius == kChoiceReach);
constexpr float kDarkest = 1e-3f;  // squared luminance below which errors are no longer relative
constexpr float kAlikeVariance = 1e-4f;  // relative, squared; below it, pixels count alike
constexpr float kChanceDeviations = 2;   // of chance that a candidate must be better by

// Scale and weights of all candidates' errors.
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
        scale.weight.values[i] = 1 / (noise * noise + kAlikeVariance);
    }
    scale.weights = SumAround(scale.weight);
    return scale;
}

// Estimates the squared error of the mean of both halves by that of `made`, of which `other` is the
// other half, against `reference`, whose noise squared is estimated by `noise`.
Planes ErrorOf(const Planes& made, const Planes& other, const Planes& reference,
               const Planes& noise, const ErrorScale& scale) {
    const auto square = [](float x) { return x * x; };
    Planes error(made.width, made.height, 1);
    for (size_t i = 0; i < error.Area(); ++i) {
        float sum = 0;
        for (int c = 0; c < kColours; ++c) {
            const float x = made.Plane(c)[i];
            sum += square(x - reference.Plane(c)[i]) - noise.Plane(c)[i] -
                   square(x - other.Plane(c)[i]) / 4;
        }
        error.values[i] = sum * scale.ofSquares.values[i] * scale.weight.values[i];
    }
    error = SumAround(std::move(error));
    for (size_t i = 0; i < error.Area(); ++i) error.values[i] /= scale.weights.values[i];
    return error;
}

// Returns the squared error of the samples, which is their variance, and the chance error of the
// others' estimates.
Planes ErrorOfNoise(const Planes& variance, const ErrorScale& scale) {
    Planes error(variance.width, variance.height, 1), chance = error;
    for (size_t i = 0; i < error.Area(); ++i) {
        const float noise = SumOfColours(variance, i) * scale.ofSquares.values[i];
        const float weighted = noise * scale.weight.values[i];
        error.values[i] = noise / 2;
        chance.values[i] = weighted * weighted / 2;
    }
    error = BoxMean(std::move(error), kErrorRadius);
    chance = SumAround(std::move(chance));
    for (size_t i = 0; i < error.Area(); ++i)
        error.values[i] +=
            kChanceDeviations * std::sqrt(chance.values[i]) / scale.weights.values[i];
    return error;
}

// Returns, for each of several images, 1 at the pixels where it has the least value, smoothed.
std::vector<Planes> SharesOfLeast(const std::vector<Planes>& images) {
    std::vector<Planes> shares(images.size(), Planes(images[0].width, images[0].height, 1));
    for (size_t i = 0; i < images[0].Area(); ++i) {
        size_t least = 0;
        for (size_t k = 1; k < images.size(); ++k)
            if (images[k].values[i] < images[least].values[i]) least = k;
        shares[least].values[i] = 1;
    }
    for (Planes& share : shares) share = BoxMean(std::move(share), kChoiceRadius);
    return shares;
}

}  // namespace

Halves ChooseCandidates(std::vector<Halves> candidates, const Halves& noisy,
                        const Planes& variance) {
    const ErrorScale scale = MakeErrorScale(candidates.back(), variance);
    const Planes noise = VarianceOf(noisy.a, noisy.b), ofSamples = ErrorOfNoise(variance, scale);
    const auto mix = [&](Planes Halves::*half, Planes Halves::*other) {
        std::vector<Planes> errors;
        for (const Halves& c : candidates)
            errors.push_back(ErrorOf(c.*other, c.*half, noisy.*half, noise, scale));
        errors.push_back(ofSamples);
        const std::vector<Planes> shares = SharesOfLeast(errors);
        Planes result(variance.width, variance.height, kColours);
        for (size_t k = 0; k < shares.size(); ++k) {
            const Planes& from = k < candidates.size() ? candidates[k].*half : noisy.*half;
            for (int c = 0; c < kColours; ++c)
                for (size_t i = 0; i < result.Area(); ++i)
                    result.Plane(c)[i] += from.Plane(c)[i] * shares[k].values[i];
        }
        return result;
    };
    return {mix(&Halves::a, &Halves::b), mix(&Halves::b, &Halves::a)};
}

}  // namespace lull
