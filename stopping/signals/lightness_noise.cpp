#include "stopping/signals/lightness_noise.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "stopping/signals/lightness.h"
#include "stopping/signals/svd_entropy.h"

namespace lull {

namespace {

constexpr int kSmoothingRadius = 2;  // 5 x 5 pixels
constexpr int kTextureRadius = 6;    // 13 x 13 pixels
constexpr int kNeighbourhood = 20;   // pixels a side, about as large as people look at
// Of a neighbourhood, so that few noisy pixels in it count less.
constexpr double kLeastNoisyShare = 0.25;
constexpr float kNoNoise = 0.01f;  // L*
// Limit of the noise of a block over that of its neighbourhoods, which changes the stop of no
// recorded block with human thresholds (tests/measurements/levels.py).
constexpr double kShareOfNeighbourhoods = 1.1 / 1.5;

float Finite(float x) { return std::isfinite(x) ? x : 0; }

// Whether a change of a component changes the displayed one.
bool IsDisplayed(float x) { return x > 0 && x < 1; }

double FourthPower(double x) { return (x * x) * (x * x); }

// The luminance of white can round to more than 1.
LightnessSlope<float> DisplayedLightness(float y) {
    const LightnessSlope<float> at = LightnessAt(y);
    return {std::min(100.f, at.lightness), at.slope};
}

class SumTable {
  public:
    // `value(i)` is for pixel i, row-major.
    template <typename Value>
    SumTable(int width, int height, const Value& value)
        : stride(size_t(width) + 1), sums(stride * (size_t(height) + 1)) {
        size_t i = 0;
        for (size_t y = 1; y <= size_t(height); ++y) {
            double row = 0;
            for (size_t x = 1; x < stride; ++x) {
                row += value(i++);
                sums[y * stride + x] = sums[(y - 1) * stride + x] + row;
            }
        }
    }

    double Sum(int x0, int x1, int y0, int y1) const {
        const double* top = &sums[size_t(y0) * stride];
        const double* bottom = &sums[size_t(y1) * stride];
        return (bottom[x1] - bottom[x0]) - (top[x1] - top[x0]);
    }

  private:
    size_t stride;
    std::vector<double> sums;
};

// Calls use(i, x0, x1, y0, y1) for each pixel i with the window around it, clipped by the block.
template <typename Use>
void ForWindows(int width, int height, int radius, const Use& use) {
    size_t i = 0;
    for (int y = 0; y < height; ++y) {
        const int y0 = std::max(0, y - radius), y1 = std::min(height, y + radius + 1);
        for (int x = 0; x < width; ++x, ++i)
            use(i, std::max(0, x - radius), std::min(width, x + radius + 1), y0, y1);
    }
}

// Computes LightnessNoise::texture from the pixels with a weight of 1, and not 0, alone.
std::vector<float> Texture(const std::vector<float>& lightness, const std::vector<float>& weights,
                           int width, int height) {
    const SumTable counts(width, height, [&](size_t i) { return double(weights[i]); });
    // Subtract some value of the block: variances are then exactly 0 where all are equal.
    const float origin = lightness[0];
    std::vector<double> smooth(lightness.size());
    const SumTable plain(width, height,
                         [&](size_t i) { return double((lightness[i] - origin) * weights[i]); });
    ForWindows(width, height, kSmoothingRadius, [&](size_t i, int x0, int x1, int y0, int y1) {
        if (weights[i] > 0) smooth[i] = plain.Sum(x0, x1, y0, y1) / counts.Sum(x0, x1, y0, y1);
    });

    std::vector<float> texture(lightness.size());
    const SumTable sums(width, height, [&](size_t i) { return smooth[i]; });
    const SumTable squares(width, height, [&](size_t i) { return smooth[i] * smooth[i]; });
    ForWindows(width, height, kTextureRadius, [&](size_t i, int x0, int x1, int y0, int y1) {
        const double area = std::max(1., counts.Sum(x0, x1, y0, y1));
        const double mean = sums.Sum(x0, x1, y0, y1) / area;
        const double variance = squares.Sum(x0, x1, y0, y1) / area - mean * mean;
        texture[i] = float(std::sqrt(std::max(0.0, variance)));
    });
    return texture;
}

struct PixelSums {
    int count = 0;
    double lightness = 0, squaredLightness = 0, texture = 0;
    double squaredNoise = 0, squaredMasked = 0, squaredHalf = 0, fourth = 0;

    void Add(const LightnessNoise& pixels, size_t i) {
        const double noise = pixels.noise[i], l = pixels.lightness[i], half = pixels.halfNoise[i];
        const double masked = MaskedNoise(pixels.noise[i], pixels.texture[i]);
        ++count;
        lightness += l;
        squaredLightness += l * l;
        texture += pixels.texture[i];
        squaredNoise += noise * noise;
        squaredMasked += masked * masked;
        squaredHalf += half * half;
        fourth += FourthPower(MaskedNoise(pixels.halfNoise[i], pixels.texture[i]));
    }
};

}  // namespace

std::vector<float> DisplayedLightness(std::span<const float> mean) {
    std::vector<float> lightness(mean.size() / 3);
    for (size_t i = 0; i < lightness.size(); ++i) {
        float m[3];
        for (size_t c = 0; c < 3; ++c) m[c] = Displayed(Finite(mean[3 * i + c]));
        lightness[i] = LightnessAt(Luminance(m[0], m[1], m[2])).lightness;
    }
    return lightness;
}

LightnessNoise ComputeLightnessNoise(const BlockView& view) {
    CheckView(view, ViewNeed::MeanAndHalf);
    const size_t pixels = view.mean.size() / 3;
    LightnessNoise result;
    result.lightness.resize(pixels);
    result.noise.resize(pixels);
    result.halfNoise.resize(pixels);
    for (size_t i = 0; i < pixels; ++i) {
        float m[3], a[3], b[3], change[3];  // displayed of all, of the halves; displayed noise
        for (size_t c = 0; c < 3; ++c) {
            const float all = Finite(view.mean[3 * i + c]), half = Finite(view.halfMean[3 * i + c]);
            m[c] = Displayed(all);
            a[c] = Displayed(half);
            b[c] = Displayed(2 * all - half);
            // (A - B) / 2 = A - M, which is between -M and M where no sample is negative.
            change[c] = IsDisplayed(all) ? std::clamp(half - all, -1.f, 1.f) : 0;
        }
        const LightnessSlope<float> at = DisplayedLightness(Luminance(m[0], m[1], m[2]));
        result.lightness[i] = at.lightness;
        result.noise[i] = at.slope * Luminance(change[0], change[1], change[2]);
        result.halfNoise[i] = (DisplayedLightness(Luminance(a[0], a[1], a[2])).lightness -
                               DisplayedLightness(Luminance(b[0], b[1], b[2])).lightness) /
                              2;
    }
    std::vector<float> weights(pixels, 1);
    result.texture = Texture(result.lightness, weights, view.width, view.height);
    for (size_t i = 0; i < pixels; ++i) weights[i] = std::abs(result.halfNoise[i]) >= kNoNoise;
    result.textureOfNoisy = std::ranges::count(weights, 0.f) == 0
                                ? result.texture
                                : Texture(result.lightness, weights, view.width, view.height);
    return result;
}

double PeakNoise(const LightnessNoise& pixels) {
    double sum = 0;
    for (size_t i = 0; i < pixels.halfNoise.size(); ++i)
        sum += FourthPower(MaskedNoise(pixels.halfNoise[i], pixels.texture[i]));
    return std::sqrt(std::sqrt(sum / double(std::max<size_t>(1, pixels.halfNoise.size()))));
}

namespace {

// Returns the root of the mean square of neighbourhoods, weighted by their squares, so that those
// without noise do not count, in proportion to the limits.
double PeakOfNeighbourhoods(double squares, double fourths) {
    return squares > 0 ? kShareOfNeighbourhoods * std::sqrt(fourths / squares) : 0;
}

}  // namespace

double LocalPeakNoise(const LightnessNoise& pixels, int width, int height) {
    const std::vector<int> xs = SplitEvenly(width, std::max(1, width / kNeighbourhood)),
                           ys = SplitEvenly(height, std::max(1, height / kNeighbourhood));
    double squares = 0, fourths = 0;
    for (size_t v = 0; v + 1 < ys.size(); ++v)
        for (size_t u = 0; u + 1 < xs.size(); ++u) {
            double fourth = 0, count = 0;
            for (int y = ys[v]; y < ys[v + 1]; ++y)
                for (int x = xs[u]; x < xs[u + 1]; ++x) {
                    const size_t i = size_t(y) * size_t(width) + size_t(x);
                    if (std::abs(pixels.halfNoise[i]) < kNoNoise) continue;
                    fourth +=
                        FourthPower(MaskedNoise(pixels.halfNoise[i], pixels.textureOfNoisy[i]));
                    ++count;
                }
            count = std::max(count, kLeastNoisyShare * (xs[u + 1] - xs[u]) * (ys[v + 1] - ys[v]));
            fourths += fourth;
            squares += std::sqrt(fourth * count);
        }
    return PeakOfNeighbourhoods(squares, fourths);
}

double PeakOf(std::span<const float> subBlocks) {
    double squares = 0, fourths = 0;
    for (const float peak : subBlocks) {
        squares += double(peak) * peak;
        fourths += FourthPower(peak);
    }
    const double mean = fourths / double(std::max<size_t>(1, subBlocks.size()));
    return std::max(std::sqrt(std::sqrt(mean)), PeakOfNeighbourhoods(squares, fourths));
}

std::vector<float> BellShapedPeaks(std::span<const float> noise, std::span<const float> maskedNoise,
                                   std::span<const float> halfNoise) {
    const float kurtosisRoot = std::pow(3.f, 0.25f);
    std::vector<float> peaks;
    for (size_t i = 0; i < noise.size(); ++i)
        peaks.push_back(kurtosisRoot * halfNoise[i] *
                        (noise[i] > 0 ? std::min(1.f, maskedNoise[i] / noise[i]) : 1));
    return peaks;
}

LightnessNoiseStatistics SubBlockStatistics(const LightnessNoise& pixels, int width, int height,
                                            int subBlocks) {
    const int side = int(std::lround(std::sqrt(std::max(0, subBlocks))));
    if (side < 1 || side * side != subBlocks || width < side || height < side)
        throw std::invalid_argument("a block cannot be cut into that many sub-blocks");
    const size_t needed = size_t(width) * size_t(height);
    for (const auto* values :
         {&pixels.lightness, &pixels.noise, &pixels.halfNoise, &pixels.texture})
        if (values->size() != needed)
            throw std::invalid_argument("noise estimates do not have the block's size");

    LightnessNoiseStatistics result;
    const std::vector<int> xs = SplitEvenly(width, side), ys = SplitEvenly(height, side);
    for (int v = 0; v < side; ++v)
        for (int u = 0; u < side; ++u) {
            PixelSums sums;
            for (int y = ys[size_t(v)]; y < ys[size_t(v) + 1]; ++y)
                for (int x = xs[size_t(u)]; x < xs[size_t(u) + 1]; ++x)
                    sums.Add(pixels, size_t(y) * size_t(width) + size_t(x));
            const double mean = sums.lightness / sums.count;
            const double variance = sums.squaredLightness / sums.count - mean * mean;
            result.lightness.push_back(float(mean));
            result.deviation.push_back(float(std::sqrt(std::max(0.0, variance))));
            result.texture.push_back(float(sums.texture / sums.count));
            result.noise.push_back(float(std::sqrt(sums.squaredNoise / sums.count)));
            result.maskedNoise.push_back(float(std::sqrt(sums.squaredMasked / sums.count)));
            result.halfNoise.push_back(float(std::sqrt(sums.squaredHalf / sums.count)));
            result.peak.push_back(float(std::sqrt(std::sqrt(sums.fourth / sums.count))));
        }
    return result;
}

}  // namespace lull
