#include "renderer/guiding/guide_record.h"

#include <atomic>

namespace lull {

namespace {

// Records are clamped to [2^-20, 2^16] times the usual value: fireflies would bend the guide, and
// no sum can overflow before 2^23 records of the largest cost.
constexpr float kScale = 0x1p20f, kLargest = 0x1p16f;
constexpr float kBits = 16, kLeastRatio = 0x1p-16f;  // of a density over another, either way

void AddTo(uint64_t* sum, float value) {
    std::atomic_ref(*sum).fetch_add(uint64_t(value * kScale + 0.5f), std::memory_order_relaxed);
}

// Returns bits that depend on the vertex alone.
uint64_t Hash(const GuideVertex& v) {
    const auto pair = [](float a, float b) {
        return uint64_t(std::bit_cast<uint32_t>(a)) << 32 | std::bit_cast<uint32_t>(b);
    };
    uint64_t h = 0;
    for (const uint64_t bits :
         {pair(v.p.x(), v.p.y()), pair(v.p.z(), v.w.x()), pair(v.w.y(), v.w.z())}) {
        h = (h ^ bits) * 0x9e3779b97f4a7c15ull;
        h ^= h >> 32;
    }
    h *= 0xbf58476d1ce4e5b9ull;
    return h ^ (h >> 32);
}

// Returns log2(x), off by 1.2e-4 at most, which is enough to choose a fraction by, for normal x >
// 0.
inline float QuickLog2(float x) {
    const auto bits = std::bit_cast<uint32_t>(x);
    const float m = std::bit_cast<float>((bits & 0x7fffffu) | 0x3f800000u) - 1;
    const float exponent = float(int(bits >> 23) - 127);
    return exponent + m + m * (1 - m) * (0.438724786f + m * (0.0821276576f * m - 0.23905455f));
}

void AddCosts(const GuideVertex& v, float found, GuideRecord::LeafSums* leaf) {
    constexpr size_t kCount = GuideRecord::kFractions.size();
    std::array<float, kCount> costs;
    for (size_t i = 0; i < kCount; ++i) {
        const float a = GuideRecord::kFractions[i];
        const float pdf = a * v.guidePdf + (1 - a) * v.bsdfPdf;
        // In this order NaN, of infinite densities, counts as the least.
        const float ratio = std::min(std::max(kLeastRatio, v.pdf / pdf), 1 / kLeastRatio);
        costs[i] = found * (kBits + QuickLog2(ratio));
    }
    for (size_t i = 0; i < kCount; ++i) AddTo(&leaf->cost[i], costs[i]);
}

}  // namespace

void GuideRecord::Add(const Guide& guide, const GuideVertex& v) {
    LeafSums& leaf = leaves[v.leaf];
    std::atomic_ref(leaf.vertices).fetch_add(1, std::memory_order_relaxed);
    if (!(v.found > 0) || !(v.pdf > 0)) return;
    const float found = std::min(v.found, kLargest);
    const uint64_t h = Hash(v);
    AddCosts(v, found, &leaf);

    // Blur: light goes to a random place within the size of the leaf (Müller 2019, stochastic
    // spatial filter).
    const auto number = [&](int shift) { return float((h >> shift) & 0xffff) * 0x1p-16f; };
    const Vec3f moved = guide.Jitter(v.p, guide.Leaf(v.leaf), {number(0), number(16), number(32)});
    AddTo(&sums[guide.Quadrant(guide.Leaf(guide.Find(moved)), v.w)], found);
}

}  // namespace lull
