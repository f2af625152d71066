#include "renderer/denoise/visible_error.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

namespace lull {

namespace {

constexpr double kMostError = 100;  // in lightness: black instead of white
// Part of the estimated error in lightness whose visible difference is the true one, on geometric
// mean over 16 images at the stops of 13 scenes (tests/measurements/renderer.md). It is estimated
// from above (FromSamples()).
constexpr double kTrueShare = 0.95;

// Returns the lightness that a block lacks, where its error is `ratio` times HalfDifference().
Planes MissingIn(const Halves& halves, const Halves& noisy, std::span<const float> slope,
                 float ratio) {
    const Planes& size = noisy.a;
    CrossedResiduals crossed;
    for (Planes* p : {&crossed.a, &crossed.b, &crossed.noise, &crossed.half})
        *p = Planes(size.width, size.height, 1);
    for (size_t i = 0; i < size.Area(); ++i) {
        const auto lightness = [&](float luminance) {
            return std::clamp(slope[i] * luminance, -kLargest, kLargest);
        };
        const float a = LuminanceOf(halves.a, i), b = LuminanceOf(halves.b, i);
        const float noisyA = noisy.a.values[i], noisyB = noisy.b.values[i];
        crossed.a.values[i] = lightness(a - noisyB);
        crossed.b.values[i] = lightness(b - noisyA);
        crossed.noise.values[i] = lightness(noisyA - noisyB);
        crossed.half.values[i] = lightness((a - b) / 2);
    }
    return MissingDetail(crossed, ratio);
}

struct ShownBlock {
    Planes picture;
    std::vector<float> slope;  // of lightness by luminance
    std::vector<float> sure;   // share of the luminance that is not fireflies' doubtful light
    VisibleReference reference;

    // Compares the picture with its sum with `ratio` times the noise, R, G, B, and the missing
    // lightness, less the doubtful light.
    VisibleDifference Compare(const Planes& noise, float ratio, const Planes& missing) const {
        Planes other = picture;
        for (size_t i = 0; i < picture.Area(); ++i) {
            const float luminance = slope[i] > 0 ? missing.values[i] / slope[i] : 0;
            for (int c = 0; c < kColours; ++c)
                other.Plane(c)[i] =
                    sure[i] * picture.Plane(c)[i] + ratio * noise.Plane(c)[i] + luminance;
        }
        return FindVisibleDifference(Interleaved(other), reference);
    }
};

ShownBlock Show(Planes picture, const Planes& returned, const DisplayModel& display) {
    ShownBlock block;
    block.picture = std::move(picture);
    for (size_t i = 0; i < block.picture.Area(); ++i) {
        const float y = LuminanceOf(block.picture, i);
        block.slope.push_back(DisplayedLightness(y).slope);
        block.sure.push_back(y > 0 ? std::max(0.f, 1 - returned.values[i] / y) : 1);
    }
    block.reference = PrepareReference(Interleaved(block.picture), block.picture.width,
                                       block.picture.height, display);
    return block;
}

Planes HalfDifference(const Halves& halves) {
    Planes half = halves.a;
    for (size_t i = 0; i < half.values.size(); ++i)
        half.values[i] = (half.values[i] - halves.b.values[i]) / 2;
    return half;
}

void Clear(std::span<const size_t> pixels, const PixelRect& block, EstimatedError* error) {
    for (const size_t i : pixels) {
        const int x = block.min.x() + int(i) % block.Width(),
                  y = block.min.y() + int(i) / block.Width();
        for (Planes* plane : {&error->squared, &error->deviation, &error->least})
            plane->Row(0, y)[x] = 0;
    }
}

}  // namespace

VisibleError MeasureVisibleError(const DenoisedPicture& denoised, EstimatedError error,
                                 const PixelRect& pixels, const DisplayModel& display) {
    const ImageTile tile{pixels.min.x(), pixels.min.y(), pixels.max.x(), pixels.max.y()};
    const ShownBlock block =
        Show(Crop(denoised.picture, tile), Crop(denoised.returned, tile), display);
    const Halves halves = Crop(denoised.halves, tile), noisy = Crop(error.noisy, tile);
    const Planes structure = Crop(error.structure, tile);
    Planes noise = HalfDifference(halves);

    std::vector<float> wrong;  // in lightness
    for (size_t i = 0; i < noise.Area(); ++i)
        wrong.push_back(block.slope[i] * LuminanceOf(noise, i));
    const Planes none(noise.width, noise.height, 1);
    const std::vector<size_t> worst = WorstPixels(block.Compare(noise, 1, none), wrong);
    Clear(worst, pixels, &error);
    const LightnessError lightness = MeasureLightnessError(error, pixels);
    const auto ratioOf = [&](double magnitude) {
        return lightness.least > 0 ? float(magnitude / lightness.least) : 1;
    };
    const float estimate = ratioOf(kTrueShare * lightness.estimate),
                upper = ratioOf(lightness.upper);
    VisibleError result;
    for (const size_t i : worst) {
        const double most = std::min(kMostError, std::abs(double(upper * wrong[i])));
        if (most >= kNoticedError) {
            ++result.worstPixels;
            result.worst = std::max(result.worst, most);
        }
        for (int c = 0; c < kColours; ++c) noise.Plane(c)[i] = 0;
    }
    Planes missing = MissingIn(halves, noisy, block.slope, upper);
    for (size_t i = 0; i < missing.Area(); ++i) missing.values[i] += structure.values[i];
    result.estimate = PooledDifference(block.Compare(noise, estimate, structure));
    result.upper =
        std::max(result.estimate, PooledDifference(block.Compare(noise, upper, missing)));
    return result;
}

namespace {

constexpr double kDeviations = 2;
// Of the values of a band, neighbours are not independent.
constexpr double kIndependent = 0.25;
// The residual of a band has noise, too, much of it where the eye is less sensitive than to what is
// missing. Chosen on hard cases of texture (tests/hard_cases/denoising.cpp).
constexpr double kPattern = 1.5;
constexpr int kSmallestSide = 8;  // pixels; coarser bands have too few values to tell

Plane TakeBand(Plane* image) {
    Plane coarse = Reduce(*image), band = Expand(coarse, image->width, image->height);
    for (size_t i = 0; i < band.values.size(); ++i)
        band.values[i] = image->values[i] - band.values[i];
    *image = std::move(coarse);
    return band;
}

// Returns an upper estimate of the excess of a band's mean squared error; 0 if not significant.
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

namespace {

constexpr size_t kPixelsPerWorst = 5000;

}  // namespace

std::vector<size_t> WorstPixels(const VisibleDifference& difference,
                                std::span<const float> lightness) {
    std::vector<float> seen = VisibleMap(difference);
    for (size_t i = 0; i < seen.size(); ++i) seen[i] *= std::abs(lightness[i]);
    std::vector<size_t> pixels(seen.size());
    std::iota(pixels.begin(), pixels.end(), size_t(0));
    const auto end = pixels.begin() + std::ptrdiff_t(seen.size() / kPixelsPerWorst);
    std::ranges::partial_sort(pixels, end, [&](size_t i, size_t j) {
        return seen[i] > seen[j] || (seen[i] == seen[j] && i < j);
    });
    pixels.erase(end, pixels.end());
    return pixels;
}

}  // namespace lull
