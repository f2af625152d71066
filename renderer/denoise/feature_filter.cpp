#include "renderer/denoise/feature_filter.h"

#include "renderer/denoise/patch_weights.h"

namespace lull {

namespace {

constexpr PatchOptions kFeaturePatches{.radius = 5, .patchRadius = 3};
constexpr float kLeastFeatureVariance = 1e-6f;  // below it noise is of no importance

// Adds half of what the weights of `guide` make of `image`.
void AddFiltered(const Planes& image, const PatchGuide& guide, Planes* result) {
    ForEachTile(image.width, image.height, [&](const ImageTile& tile) {
        const PatchWeights weights(guide, tile, 0, kFeaturePatches);
        const Cutout values(tile.Grown(kFeaturePatches.radius), image);
        std::vector<Lanes> sums(size_t(image.count));
        for (int y = tile.y0; y < tile.y1; ++y)
            for (int x = tile.x0; x < tile.x1; x += kLanes) {
                Lanes norm = Lanes::Zero();
                std::ranges::fill(sums, norm);
                for (int o = 0; o < int(weights.Offsets().size()); ++o) {
                    const Lanes w = weights.Of(o, x, y, 1);
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
    });
}

}  // namespace

Planes FilterFeatures(const Planes& a, const Planes& b) {
    Planes variance = BoxMean(VarianceOf(a, b), 1);
    for (float& v : variance.values) v += kLeastFeatureVariance;
    Planes result(a.width, a.height, a.count);
    AddFiltered(a, {b, variance}, &result);
    AddFiltered(b, {a, variance}, &result);
    return result;
}

}  // namespace lull
