#include "renderer/base/sampler.h"

namespace lull {
namespace {

uint32_t ReverseBits(uint32_t x) {
    x = __builtin_bswap32(x);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
    x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
    return ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
}

// Permutes nested uniformly, all bits below each bit at once (Laine and Karras 2011, with the
// constants of Vegdahl 2021); works on reversed bits.
uint32_t LaineKarras(uint32_t x, uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

// Returns the second dimension of Sobol's sequence, its bits reversed. The matrix is then Pascal's
// triangle mod 2, which takes a polynomial p(x) over GF(2) to p(x + 1); as (x + 1)^(2^j) is
// x^(2^j) + 1, one shift does all powers whose exponents have bit j.
uint32_t SobolSecondReversed(uint32_t index) {
    index ^= (index >> 1) & 0x55555555u;
    index ^= (index >> 2) & 0x33333333u;
    index ^= (index >> 4) & 0x0f0f0f0fu;
    index ^= (index >> 8) & 0x00ff00ffu;
    return index ^ (index >> 16);
}

float ToUnit(uint32_t x) { return float(x >> 8) * 0x1p-24f; }

}  // namespace

void Sampler::StartSample(const Vec2i& pixel, uint32_t sampleIndex) {
    const uint64_t place = (uint64_t(uint32_t(pixel.y())) << 32) | uint32_t(pixel.x());
    state = MixBits(MixBits(seed + 0x9e3779b97f4a7c15ull) ^ place);
    if (kind == SamplerKind::Random)
        state = MixBits(state + 0xd1342543de82ef95ull * (uint64_t(sampleIndex) + 1));
    const bool hasHalves = kind == SamplerKind::SobolHalves;
    if (hasHalves) state = MixBits(state + 0xd1342543de82ef95ull * (InHalf(sampleIndex) ? 2 : 1));
    reversedIndex = ReverseBits(hasHalves ? PlaceInHalf(sampleIndex) : sampleIndex);
    dimension = 0;
    nextPair = kPairs;
}

// Pads independent two-dimensional Owen-scrambled Sobol sets: the index is shuffled again for each
// pair, which keeps every pair a (0,2)-sequence over the samples of a pixel (Burley 2020). To
// scramble a number is to reverse its bits, permute and reverse them back; the first dimension is
// itself the reversed index, and of the second only the last reversal remains.
void Sampler::MakePairs() {
    for (uint32_t i = 0; i < kPairs; ++i) {
        const uint64_t h = MixBits(state + 0x9e3779b97f4a7c15ull * (dimension + i + 1));
        const uint64_t g = MixBits(h);
        const uint32_t shuffled = ReverseBits(LaineKarras(reversedIndex, uint32_t(h)));
        const uint32_t x = LaineKarras(shuffled, uint32_t(g));
        const uint32_t y = LaineKarras(SobolSecondReversed(shuffled), uint32_t(g >> 32));
        xs[i] = ToUnit(ReverseBits(x));
        ys[i] = ToUnit(ReverseBits(y));
    }
    dimension += kPairs;
}

}  // namespace lull
