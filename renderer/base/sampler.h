// Gives every sample of every pixel its own numbers: addressable by (seed, pixel, sample index,
// dimension), so that any thread can take any sample at any time; and divides the samples of a
// pixel into two halves, by which noise is estimated.
#pragma once

#include <array>
#include <bit>
#include <cstdint>

#include "renderer/base/math.h"
#include "renderer/base/variant.h"
#include "stopping/base/hash.h"

namespace lull {

// Returns whether sample `index` belongs to the half on which noise is estimated: the bits at its
// odd places have odd parity. Any multiple of four samples, from 0 on, has exactly half in it,
// and both halves of a Sobol sequence stay well distributed (Cycles chooses the same way).
inline bool InHalf(uint32_t index) { return std::popcount(index & 0xaaaaaaaau) & 1; }

// Returns the place of sample `index` among those of its half: of four, either has one pair.
inline uint32_t PlaceInHalf(uint32_t index) { return ((index >> 2) << 1) | (index & 1); }

// The samples of one Sobol sequence complement each other, so that its halves (InHalf()) differ by
// more than the noise of each. SobolHalves has a sequence for either, independent of the other,
// from whose difference noise can be estimated.
enum class SamplerKind { Random, Sobol, SobolHalves };
template <>
struct EnumNames<SamplerKind> {
    static constexpr std::pair<SamplerKind, const char*> all[] = {
        {SamplerKind::Random, "random"},
        {SamplerKind::Sobol, "sobol"},
        {SamplerKind::SobolHalves, "sobol-halves"}};
};

class Sampler {
  public:
    Sampler(SamplerKind kind, uint64_t seed) : seed(seed), kind(kind) {}

    // Starts sample `index` of the pixel, at dimension 0.
    void StartSample(const Vec2i& pixel, uint32_t index);

    // Return the next one or two dimensions, each in [0, 1).
    float Get1D() { return kind == SamplerKind::Random ? UnitFloat(NextRandom()) : xs[NextPair()]; }
    Vec2f Get2D() { return kind == SamplerKind::Random ? Random2D() : Sobol2D(); }

  private:
    // Advances SplitMix64 (Steele, Lea, Flood 2014): a counter through a mixing function, so that
    // each number costs two multiplications, and starting a sample a hash.
    uint64_t NextRandom() { return MixBits(state += 0x9e3779b97f4a7c15ull); }
    Vec2f Random2D() {
        const uint64_t r = NextRandom();
        return {UnitFloat(r), float((r >> 8) & 0xffffff) * 0x1p-24f};
    }
    // Sobol: returns the index of the next pair among those made.
    uint32_t NextPair() {
        if (nextPair == kPairs) {
            MakePairs();
            nextPair = 0;
        }
        return nextPair++;
    }
    Vec2f Sobol2D() {
        const uint32_t i = NextPair();
        return {xs[i], ys[i]};
    }
    void MakePairs();

    static constexpr uint32_t kPairs = 8;
    uint64_t seed;
    uint64_t state = 0;  // random: the counter; Sobol: the hash of (seed, pixel, half)
    // Sobol only: the index in the sequence with its bits reversed; how many pairs of dimensions
    // have been made; the last kPairs of them, and which one is next.
    uint32_t reversedIndex = 0, dimension = 0, nextPair = kPairs;
    std::array<float, kPairs> xs{}, ys{};
    SamplerKind kind;
};

}  // namespace lull
