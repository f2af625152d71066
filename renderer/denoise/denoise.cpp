#include "renderer/denoise/denoise.h"

#include <cmath>

#include "renderer/denoise/feature_filter.h"
#include "renderer/denoise/fireflies.h"
#include "renderer/denoise/scales.h"

namespace lull {

namespace {

constexpr PatchOptions kPatches{.radius = 7, .patchRadius = 3};
constexpr float kBandwidths[] = {0.5f, 1.4f};
constexpr int kScales = 3;          // of which each has half the size of that before
constexpr int kLeastSide = 20;      // pixels of a picture that is looked at in half of its size
constexpr float kFireflyLimit = 8;  // standard deviations
constexpr float kLargest = 1e18f;   // its square is finite
constexpr float kLeastLuminance = 1e-3f;
constexpr int kNoiseRadius = 10;  // pixels over which halves say how large noise is
constexpr float kLeastVariance = 1e-10f;

float Sane(float x) { return x > 0 ? std::min(x, kLargest) : 0; }

void MakeSane(Halves* halves) {
    for (Planes* half : {&halves->a, &halves->b})
        for (float& v : half->values) v = Sane(v);
}

// Brings features to [-1, 1]: of one over the depth, d becomes d / (d + median), which is 0 where
// there is nothing.
void ScaleFeatures(Halves* halves) {
    constexpr int disparity = kFeatures - 1;
    std::vector<float> found;
    for (Planes* half : {&halves->a, &halves->b}) {
        for (int f = 0; f < disparity; ++f)
            for (size_t i = 0; i < half->Area(); ++i) {
                float& v = half->Plane(f)[i];
                v = std::isfinite(v) ? std::clamp(v, -1.f, 1.f) : 0;
            }
        for (size_t i = 0; i < half->Area(); ++i) {
            float& d = half->Plane(disparity)[i];
            d = Sane(d);
            if (d > 0) found.push_back(d);
        }
    }
    if (found.empty()) return;
    const auto middle = found.begin() + ptrdiff_t(found.size() / 2);
    std::nth_element(found.begin(), middle, found.end());
    for (Planes* half : {&halves->a, &halves->b})
        for (size_t i = 0; i < half->Area(); ++i) {
            float& d = half->Plane(disparity)[i];
            d /= d + *middle;
        }
}

// Estimates the variance of a pixel of either half: what the samples' squares say of the luminance,
// shared out by colour, scaled to what the halves differ by in the pixels around, since points that
// fill space evenly have less noise than their squares say.
Planes EstimateVariance(const Halves& colour, const Planes& ofMean) {
    const Planes differences = VarianceOf(colour.a, colour.b);
    if (ofMean.count == 0) return BoxMean(BoxMean(differences, 1), 1);
    Planes variance = differences;
    for (size_t i = 0; i < variance.Area(); ++i) {
        Rgb mean;
        for (int c = 0; c < kColours; ++c)
            mean[c] = std::max(kLeastLuminance, (colour.a.Plane(c)[i] + colour.b.Plane(c)[i]) / 2);
        const float y = Luminance(mean);
        const float relative = 2 * Sane(ofMean.values[i]) / (y * y);
        for (int c = 0; c < kColours; ++c)
            variance.Plane(c)[i] = std::min(relative * mean[c] * mean[c], kLargest);
    }
    const Planes seen = BoxMean(differences, kNoiseRadius), said = BoxMean(variance, kNoiseRadius);
    for (size_t i = 0; i < variance.values.size(); ++i)
        variance.values[i] *=
            std::clamp(seen.values[i] / std::max(said.values[i], 1e-12f), 0.2f, 5.f);
    return BoxMean(std::move(variance), 1);
}

// Returns what is made of both halves: by fits in windows of some pixels, and by the same at half
// of the size for what is wider than these.
Halves FilterColours(const Halves& noisy, Planes features, const Planes& variance, int scales,
                     int rowsPerFit) {
    std::vector<Planes> a =
        Regress(noisy.a, features, {noisy.b, variance}, kPatches, kBandwidths, rowsPerFit);
    std::vector<Planes> b =
        Regress(noisy.b, features, {noisy.a, variance}, kPatches, kBandwidths, rowsPerFit);
    const bool isCoarsest =
        scales == 1 || std::min(variance.width, variance.height) < 2 * kLeastSide;
    features = isCoarsest ? Planes() : Halved(features);
    std::vector<Halves> candidates;
    for (size_t i = 0; i < a.size(); ++i) candidates.push_back({std::move(a[i]), std::move(b[i])});
    Halves fine = ChooseCandidates(std::move(candidates), noisy, variance);
    if (isCoarsest) return fine;

    Planes ofMeans = Halved(variance);
    for (float& v : ofMeans.values) v /= 4;
    const Halves coarse = FilterColours({Halved(noisy.a), Halved(noisy.b)}, std::move(features),
                                        ofMeans, scales - 1, rowsPerFit);
    Halves both{WithCoarsePart(fine.a, coarse.a), WithCoarsePart(fine.b, coarse.b)};
    candidates.clear();
    candidates.push_back(std::move(fine));
    candidates.push_back(std::move(both));
    return ChooseCandidates(std::move(candidates), noisy, variance);
}

}  // namespace

DenoisedPicture Denoise(NoisyPicture in, int rowsPerFit) {
    MakeSane(&in.colour);
    CalmedHalves calm = TakeFireflies(in.colour.a, in.colour.b, kFireflyLimit);
    DenoisedPicture result;
    result.noisy = {std::move(calm.a), std::move(calm.b)};
    result.excess = std::move(calm.excess);
    result.variance = EstimateVariance(in.colour, in.variance);
    for (float& v : result.variance.values) v = std::max(v, kLeastVariance);
    in.colour = {};  // a large picture needs the memory, here and below

    ScaleFeatures(&in.features);
    Planes features = FilterFeatures(in.features.a, in.features.b);
    in.features = {};
    result.halves =
        FilterColours(result.noisy, std::move(features), result.variance, kScales, rowsPerFit);

    result.picture = result.halves.a;
    for (size_t i = 0; i < result.picture.values.size(); ++i)
        result.picture.values[i] =
            Sane((result.halves.a.values[i] + result.halves.b.values[i]) / 2);
    GiveBack(result.excess, &result.picture);
    return result;
}

}  // namespace lull
