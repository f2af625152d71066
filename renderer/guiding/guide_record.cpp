#include "renderer/guiding/guide_record.h"

#include <atomic>

namespace lull {

namespace {

// What is found lies in [2^-20, 2^16] times what is usual, or is cut: fireflies would bend the
// guide and no sum can overflow before 2^23 records of the largest cost.
constexpr float kScale = 0x1p20f, kLargest = 0x1p16f;
constexpr float kBits = 16;  // of a density over another, either way

void AddTo(uint64_t* sum, float value) {
    std::atomic_ref(*sum).fetch_add(uint64_t(value * kScale + 0.5f), std::memory_order_relaxed);
}

uint64_t Hash(const GuideVertex& v) {
    uint64_t h = 0;
    for (const float x : {v.p.x(), v.p.y(), v.p.z(), v.w.x(), v.w.y(), v.w.z()}) {
        h = (h ^ std::bit_cast<uint32_t>(x)) * 0x9e3779b97f4a7c15ull;
        h ^= h >> 29;
    }
    h = (h ^ (h >> 32)) * 0xbf58476d1ce4e5b9ull;
    return h ^ (h >> 32);
}

}  // namespace

void GuideRecord::Add(const Guide& guide, const GuideVertex& v) {
    LeafSums& leaf = leaves[guide.Find(v.p)];
    std::atomic_ref(leaf.vertices).fetch_add(1, std::memory_order_relaxed);
    if (!(v.found > 0) || !(v.pdf > 0)) return;
    const float found = std::min(v.found, kLargest);
    for (size_t i = 0; i < kFractions.size(); ++i) {
        const float a = kFractions[i], pdf = a * v.guidePdf + (1 - a) * v.bsdfPdf;
        const float bits = pdf > 0 ? std::log2(v.pdf / pdf) : kBits;
        // In this order NaN, of infinite densities, counts as the least.
        AddTo(&leaf.cost[i], found * (kBits + std::min(std::max(-kBits, bits), kBits)));
    }

    // Blur: light goes to a random place within the size of the leaf (Müller 2019, stochastic
    // spatial filter). The numbers depend on the vertex alone.
    const uint64_t h = Hash(v);
    const auto number = [&](int shift) { return float((h >> shift) & 0xffff) * 0x1p-16f; };
    const GuideLeaf& own = guide.Leaf(guide.Find(v.p));
    const Vec3f moved = guide.Jitter(v.p, own, {number(0), number(16), number(32)});
    AddTo(&sums[guide.Quadrant(guide.Leaf(guide.Find(moved)), v.w)], found);
}

}  // namespace lull
