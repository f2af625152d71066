#include "renderer/base/sampler.h"

namespace lull {
namespace {

uint64_t Mix(uint64_t z) {
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
    return z ^ (z >> 31);
}

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

uint32_t OwenScramble(uint32_t x, uint32_t seed) {
    return ReverseBits(LaineKarras(ReverseBits(x), seed));
}

// Returns the second dimension of Sobol's sequence: its matrix is Pascal's triangle mod 2, so
// each column follows from the one before.
uint32_t SobolSecond(uint32_t index) {
    uint32_t result = 0;
    for (uint32_t v = 1u << 31; index; index >>= 1, v ^= v >> 1)
        if (index & 1) result ^= v;
    return result;
}

}  // namespace

void Sampler::StartSample(const Vec2i& pixel, uint32_t sampleIndex) {
    const uint64_t place = (uint64_t(uint32_t(pixel.y())) << 32) | uint32_t(pixel.x());
    state = Mix(Mix(seed + 0x9e3779b97f4a7c15ull) ^ place);
    if (kind == SamplerKind::Random)
        state = Mix(state + 0xd1342543de82ef95ull * (uint64_t(sampleIndex) + 1));
    index = sampleIndex;
    dimension = 0;
}

// Pads independent two-dimensional Owen-scrambled Sobol sets: the index is shuffled anew for each
// pair, which keeps every pair a (0,2)-sequence over the samples of a pixel (Burley 2020).
Vec2f Sampler::Sobol2D() {
    const uint64_t h = Mix(state + 0x9e3779b97f4a7c15ull * ++dimension);
    const uint64_t g = Mix(h);
    const uint32_t shuffled = OwenScramble(index, uint32_t(h));
    // The first dimension is the bit reversal, which scrambling undoes again at once.
    const uint32_t x = ReverseBits(LaineKarras(shuffled, uint32_t(g)));
    const uint32_t y = OwenScramble(SobolSecond(shuffled), uint32_t(g >> 32));
    return {float(x >> 8) * 0x1p-24f, float(y >> 8) * 0x1p-24f};
}

}  // namespace lull
