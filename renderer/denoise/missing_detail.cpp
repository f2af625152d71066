#include "renderer/denoise/missing_detail.h"

#include <cmath>

#include "renderer/base/math.h"
#include "renderer/vision/image_pyramid.h"

namespace lull {

namespace {

constexpr double kDeviations = 2;
// Of the values of a band, neighbours are not independent.
constexpr double kIndependent = 0.25;
// The residual of a band has noise, too, much of it where the eye is less sensitive than to what is
// missing. Chosen on hard cases of texture (tests/hard_cases/denoising.cpp).
constexpr double kPattern = 1.5;
constexpr int kSmallestSide = 8;  // pixels; coarser bands have too few values to tell

// Takes the finest band out of an image, which is reduced.
Plane TakeBand(Plane* image) {
    Plane coarse = Reduce(*image), band = Expand(coarse, image->width, image->height);
    for (size_t i = 0; i < band.values.size(); ++i)
        band.values[i] = image->values[i] - band.values[i];
    *image = std::move(coarse);
    return band;
}

// Returns an upper estimate of the mean square by which the error of a band exceeds the expected
// one; 0 where that is not significant.
double Excess(const Plane& a, const Plane& b, const Plane& noise, const Plane& half, float ratio) {
    double sum = 0, squares = 0;
    for (size_t i = 0; i < a.values.size(); ++i) {
        const double crossed =
            (Sqr(double(a.values[i])) + Sqr(double(b.values[i])) - Sqr(double(noise.values[i]))) /
            2;
        const double excess = crossed - (1 + Sqr(double(ratio))) * Sqr(double(half.values[i]));
        sum += excess;
        squares += Sqr(excess);
    }
    const double n = double(a.values.size()), mean = sum / n;
    const double deviation = std::sqrt(std::max(0.0, squares / n - Sqr(mean)) / (kIndependent * n));
    return mean > kDeviations * deviation ? mean + kDeviations * deviation : 0;
}

}  // namespace

Planes MissingDetail(const CrossedResiduals& of, float ratio) {
    const auto image = [](const Planes& p) {
        return Plane{p.width, p.height, {p.values.begin(), p.values.end()}};
    };
    Plane a = image(of.a), b = image(of.b), noise = image(of.noise), half = image(of.half);
    std::vector<Plane> pattern;
    while (std::min(a.width, a.height) >= kSmallestSide) {
        Plane bandA = TakeBand(&a), bandB = TakeBand(&b);
        const double excess = Excess(bandA, bandB, TakeBand(&noise), TakeBand(&half), ratio);
        double square = 0;
        for (size_t i = 0; i < bandA.values.size(); ++i) {
            bandA.values[i] = -(bandA.values[i] + bandB.values[i]) / 2;
            square += Sqr(double(bandA.values[i])) / double(bandA.values.size());
        }
        const float scale = square > 0 ? float(kPattern * std::sqrt(excess / square)) : 0;
        for (float& v : bandA.values) v *= scale;
        pattern.push_back(std::move(bandA));
    }
    Planes missing(of.a.width, of.a.height, 1);
    if (pattern.empty()) return missing;
    Plane sum = std::move(pattern.back());
    for (size_t i = pattern.size() - 1; i-- > 0;) {
        sum = Expand(sum, pattern[i].width, pattern[i].height);
        for (size_t k = 0; k < sum.values.size(); ++k) sum.values[k] += pattern[i].values[k];
    }
    std::ranges::copy(sum.values, missing.values.begin());
    return missing;
}

}  // namespace lull
