// Turns bits into others, and into numbers, that look random.
#pragma once

#include <cstdint>

namespace lull {

// Returns a permutation of 64 bits in which each depends on all (Stafford 2011, variant 13).
inline uint64_t MixBits(uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
}

// Returns a hash of earlier bits, of which 0 stands for none, and of more.
inline uint64_t HashWith(uint64_t state, uint64_t bits) {
    return MixBits((state ^ bits) + 0x9e3779b97f4a7c15ull);
}

// Returns a number of [0, 1), of the upper bits.
inline float UnitFloat(uint64_t bits) { return float(bits >> 40) * 0x1p-24f; }

}  // namespace lull
