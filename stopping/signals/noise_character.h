// Describes what the noise of a block is like, besides how much there is: coloured or grey, fine or
// blotched, spread evenly or in few pixels, and how much of the picture the display saturates.
#pragma once

#include <array>

#include "stopping/signals/lightness_noise.h"

namespace lull {

// The shares of pixels below NoiseCharacter::quantiles.
inline constexpr std::array<double, 5> kNoiseQuantiles = {0.5, 0.75, 0.9, 0.95, 0.99};

// Holds statistics of each sub-block, row-major, and of the whole block.
struct NoiseCharacter {
    // Share of pixels that are white on the display: R, G and B are at 1 or above. In [0, 1].
    std::vector<float> saturated;
    // Root mean square of half the difference of the two halves of the samples in CIE 1976 a* and
    // b* (white D65): the noise in colour.
    std::vector<float> chromaNoise;
    // Correlation of LightnessNoise::noise between pixels that share an edge, both in the
    // sub-block: 0 if pixels are independent, as they are unless something has smoothed them. In
    // [-1, 1].
    std::vector<float> correlation;
    // Quantiles over the pixels of the block of |noise| FlareFactor(L) / (1 + t / 4), see
    // lightness_noise.h and entropy_drop.h, at kNoiseQuantiles.
    std::array<float, kNoiseQuantiles.size()> quantiles = {};
};

// Reads both means of the view; `noise` is what ComputeLightnessNoise() says of it, and `flare` as
// in NoiseVisibility. Throws as SubBlockStatistics() does.
NoiseCharacter DescribeNoise(const BlockView& view, const LightnessNoise& noise, int subBlocks,
                             double flare);

}  // namespace lull
