// Divides the samples of a pixel into two halves, by which noise is estimated.
#pragma once

#include <bit>
#include <cstdint>

namespace lull {

// Returns whether sample `index` belongs to the half on which noise is estimated: the bits at its
// odd places have odd parity. Any multiple of four samples, from 0 on, has exactly half in it,
// and both halves of a Sobol sequence stay well distributed (Cycles chooses the same way).
inline bool InHalf(uint32_t index) { return std::popcount(index & 0xaaaaaaaau) & 1; }

// Returns the place of sample `index` among those of its half: of four, either has one pair.
inline uint32_t PlaceInHalf(uint32_t index) { return ((index >> 2) << 1) | (index & 1); }

}  // namespace lull
