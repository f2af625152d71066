// Sums up the samples of a pixel.
#pragma once

#include <array>
#include <cstdint>

#include "renderer/base/math.h"
#include "renderer/base/sampler.h"
#include "stopping/signals/lightness.h"

namespace lull {

// Returns how many of the samples 0 .. count - 1 are in the half.
uint32_t HalfCount(uint32_t count);

// Returns the luminance of a sum of colours.
inline double Luminance(const std::array<double, 3>& sum) {
    const auto& [r, g, b] = kLuminanceWeights;
    return r * sum[0] + g * sum[1] + b * sum[2];
}

// The sums of a pixel. Samples arrive in the order of their indices, 0, 1, 2, ..., and are
// added to the running sums one by one, so that the sums are the same bits however the samples are
// cut into passes.
struct FilmPixel {
    std::array<double, 3> sum = {}, halfSum = {};
    uint32_t count = 0;
    uint32_t rejected = 0;  // samples that were NaN, infinite or negative, and count as black

    // Adds the sample of index `count`. The radiance must be finite.
    void Add(const Rgb& radiance, bool wasRejected) {
        const bool inHalf = InHalf(count);
        for (int c = 0; c < 3; ++c) {
            sum[c] += double(radiance[c]);
            if (inHalf) halfSum[c] += double(radiance[c]);
        }
        ++count;
        rejected += wasRejected;
    }
    // Return the mean of all samples, or of those in the half; without any, black, or the mean of
    // all.
    Rgb Mean() const;
    Rgb HalfMean() const;
};

}  // namespace lull
