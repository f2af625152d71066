// Estimates the noise that an observer can see in a block: in lightness, and masked by texture.
#pragma once

#include <span>
#include <vector>

#include "stopping/base/block_view.h"

namespace lull {

// Estimates for every pixel of a block, row-major.
//
// With A the mean of one half of the samples, B that of the other and M of all, (A - B) / 2 has the
// standard deviation of the error of M. Lightness L is of the displayed colour: components
// are clamped to [0, 1], but not rounded to 8 bits, which would add noise of its own.
struct LightnessNoise {
    std::vector<float> lightness;  // L of M, in [0, 100]
    // (A - B) / 2 converted to lightness by its derivative at M, zero in components that the
    // display saturates. A single signed draw from the noise of that pixel: only its square,
    // averaged over many pixels, shows how large the noise is.
    std::vector<float> noise;
    std::vector<float> halfNoise;  // (L(A) - L(B)) / 2, bounded
    // Standard deviation of L in the surrounding 13 x 13 pixels (within the block), after smoothing
    // L by 5 x 5 averages, which masks noise. Written t.
    std::vector<float> texture;
    // The same, from pixels with noise alone: the edge of a lit window in a black wall hides none.
    std::vector<float> textureOfNoisy;
};

// Returns the lightness, in [0, 100], of each pixel of linear R, G, B as a display shows it, but
// not rounded to 8 bits; values that are not finite count as 0. The same as
// LightnessNoise::lightness.
std::vector<float> DisplayedLightness(std::span<const float> mean);

// Reads both means of the view; values that are not finite count as 0. Throws as CheckView() does.
LightnessNoise ComputeLightnessNoise(const BlockView& view);

// Returns noise / (1 + t / 4): the noise that remains visible on texture.
inline float MaskedNoise(float noise, float texture) { return noise / (1 + texture / 4); }

// Returns the root of the mean fourth power of MaskedNoise(halfNoise, texture) over all pixels:
// about 1.3 times their root mean square where noise is even, and far more where few pixels have
// most of it. Visibility adds up over a picture with exponents of 3 to 4 (probability summation;
// Quick 1974, Watson 1979). 0 for no pixels.
double PeakNoise(const LightnessNoise& pixels);

// Returns the noise of those neighbourhoods of 20 x 20 pixels that have most of it, however small
// their share of the block is, times the ratio of the limits of both: below PeakNoise() where noise
// is even. Pixels without noise count neither as such nor as texture.
double LocalPeakNoise(const LightnessNoise& pixels, int width, int height);

// Returns the larger of both from the peak noise of equal sub-blocks, as neighbourhoods; 0: none.
double PeakOf(std::span<const float> subBlocks);

// Returns the peak noise of sub-blocks from root mean squares alone, as if noise were bell-shaped
// in each: 3^(1/4) of the masked half noise. Below the true one where few pixels have most of it.
std::vector<float> BellShapedPeaks(std::span<const float> noise, std::span<const float> maskedNoise,
                                   std::span<const float> halfNoise);

// Statistics of each of `subBlocks` sub-blocks (a square number), row-major. noise,
// maskedNoise and halfNoise are root mean squares, peak is PeakNoise(). Throws
// std::invalid_argument if the estimates have another size or there are too few pixels for the
// sub-blocks.
struct LightnessNoiseStatistics {
    std::vector<float> lightness, deviation, texture, noise, maskedNoise, halfNoise, peak;
};
LightnessNoiseStatistics SubBlockStatistics(const LightnessNoise&, int width, int height,
                                            int subBlocks);

}  // namespace lull
