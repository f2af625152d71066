#include "renderer/denoise/feature_filter.h"

#include <bit>
#include <cmath>

#include "renderer/denoise/patch_weights.h"

namespace lull {

namespace {

constexpr PatchOptions kFeaturePatches{.radius = 5, .patchRadius = 3};
constexpr int kVarianceRadius = 1;
// Distance up to which pixels contribute to one.
constexpr int kReach = kFeaturePatches.radius + kFeaturePatches.patchRadius + kVarianceRadius;
constexpr float kLeastFeatureVariance = 1e-6f;  // below it noise is of no importance
constexpr int kBand = 64;                       // rows that are in memory at a time
constexpr int kDisparity = kFeatures - 1;

// Returns the median of one over the depth, where there is anything; 0 if there is nothing at all.
// A radix selection in two passes, as the values are too many to keep: positive floats are in the
// order of their bits, which are counted by the upper half, then by the lower.
float MedianDisparity(int height, const FeatureReader& read) {
    constexpr uint32_t kCounters = 1 << 16;
    std::vector<int64_t> high(kCounters), low(kCounters);
    const auto forEach = [&](const auto& use) {
        for (int y = 0; y < height; y += kBand) {
            const Halves halves = read(y, std::min(height, y + kBand));
            for (const Planes* half : {&halves.a, &halves.b})
                for (size_t i = 0; i < half->Area(); ++i)
                    if (const float d = Sane(half->Plane(kDisparity)[i]); d > 0)
                        use(std::bit_cast<uint32_t>(d));
        }
    };
    // Returns where the value number `rank` is, of which `rank` is made that within there.
    const auto find = [](const std::vector<int64_t>& counts, int64_t* rank) {
        uint32_t i = 0;
        for (; *rank >= counts[i]; ++i) *rank -= counts[i];
        return i;
    };
    int64_t count = 0;
    forEach([&](uint32_t bits) { ++high[bits / kCounters], ++count; });
    if (count == 0) return 0;
    int64_t rank = count / 2;
    const uint32_t middle = find(high, &rank);
    forEach([&](uint32_t bits) { low[bits % kCounters] += bits / kCounters == middle; });
    return std::bit_cast<float>(middle * kCounters + find(low, &rank));
}

// Brings features to [-1, 1]: of one over the depth, d becomes d / (d + median), which is 0 where
// there is nothing.
void ScaleFeatures(float median, Planes* half) {
    for (int f = 0; f < kDisparity; ++f)
        for (size_t i = 0; i < half->Area(); ++i) {
            float& v = half->Plane(f)[i];
            v = std::isfinite(v) ? std::clamp(v, -1.f, 1.f) : 0;
        }
    for (size_t i = 0; i < half->Area(); ++i) {
        float& d = half->Plane(kDisparity)[i];
        d = median > 0 ? Sane(d) / (Sane(d) + median) : 0;
    }
}

// Adds half of a tile of an image, filtered by the weights of `guide`.
void AddFiltered(const Planes& image, const PatchGuide& guide, const ImageTile& tile,
                 Planes* result) {
    PatchWeights weights(guide, tile, 0, kFeaturePatches);
    const Cutout values(tile.Grown(kFeaturePatches.radius), image);
    std::vector<Lanes> sums(size_t(image.count));
    for (int y = tile.y0; y < tile.y1; ++y) {
        weights.MoveTo(y);
        for (int x = tile.x0; x < tile.x1; x += kLanes) {
            Lanes norm = Lanes::Zero();
            std::ranges::fill(sums, norm);
            for (int o = 0; o < int(weights.Offsets().size()); ++o) {
                const Lanes w = PatchWeights::WeightOf(weights.Distances(o, x), 1);
                const auto [dx, dy] = weights.Offsets()[size_t(o)];
                norm += w;
                for (int c = 0; c < image.count; ++c)
                    sums[size_t(c)] += w * LanesIn(values.At(c, x + dx, y + dy));
            }
            for (int c = 0; c < image.count; ++c) {
                const Lanes value = sums[size_t(c)] / norm * 0.5f;
                float* to = result->Row(c, y) + x;
                for (int i = 0; i < std::min(kLanes, tile.x1 - x); ++i) to[i] += value[i];
            }
        }
    }
}

}  // namespace

Planes FilterFeatures(int width, int height, const FeatureReader& read,
                      const std::function<void(int end)>& forget) {
    const float median = MedianDisparity(height, read);
    Planes result(width, height, kFeatures);
    for (int y0 = 0; y0 < height; y0 += kBand) {
        const int y1 = std::min(height, y0 + kBand);
        const int first = std::max(0, y0 - kReach), end = std::min(height, y1 + kReach);
        Halves halves = read(first, end);
        for (Planes* half : {&halves.a, &halves.b}) ScaleFeatures(median, half);
        Planes variance = BoxMean(VarianceOf(halves.a, halves.b), kVarianceRadius);
        for (float& v : variance.values) v += kLeastFeatureVariance;
        Planes filtered(width, end - first, kFeatures);
        ForEachTile(width, y0 - first, y1 - first, [&](const ImageTile& tile) {
            AddFiltered(halves.a, {halves.b, variance}, tile, &filtered);
            AddFiltered(halves.b, {halves.a, variance}, tile, &filtered);
        });
        Paste(filtered, {0, y0 - first, width, y1 - first}, 0, y0, &result);
        if (forget) forget(std::max(0, y1 - kReach));
    }
    return result;
}

}  // namespace lull
