#include "renderer/denoise/regression.h"

#include <gtest/gtest.h>

#include "tests/renderer/denoise/example_pictures.h"

namespace lull {
namespace {

constexpr PatchOptions kPatches{.radius = 5, .patchRadius = 2};
constexpr float kBandwidths[] = {0.5f, 1.f};

// Returns what becomes of a picture, tile by tile.
std::vector<Planes> Regress(const Planes& colour, const Planes& features, const PatchGuide& guide,
                            int rowsPerFit = 1) {
    std::vector<Planes> pictures(2, Planes(colour.width, colour.height, 3));
    for (int y = 0; y < colour.height; y += 64)
        ForEachTile(colour.width, y, std::min(y + 64, colour.height), [&](const ImageTile& tile) {
            const std::vector<Planes> made =
                RegressTile({colour, features, guide, kPatches, kBandwidths, rowsPerFit}, tile);
            for (size_t b = 0; b < 2; ++b)
                Paste(made[b], {0, 0, made[b].width, made[b].height}, tile.x0, tile.y0,
                      &pictures[b]);
        });
    return pictures;
}

// What is linear in the features is found exactly, but for what the ridge takes.
TEST(Regression, FindsWhatIsLinearInFeatures) {
    const int width = 150, height = 140;  // several tiles
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const Planes features =
        MakePlanes(width, height, kFeatures, [&](int, int, int) { return uniform(generator); });
    const Planes colour = MakePlanes(width, height, 3, [&](int c, int x, int y) {
        double value = 2 + 0.01 * x + 0.02 * y;
        for (int f = 0; f < kFeatures; ++f) value += (c + 1) * 0.1 * f * features.Row(f, y)[x];
        return value;
    });
    const Planes flat(width, height, 3, 1), variance(width, height, 3, 1);
    for (const Planes& result : Regress(colour, features, {flat, variance}))
        EXPECT_LT(Rms(result, colour), 0.01);
}

TEST(Regression, AveragesWhatFeaturesDoNotTell) {
    const Planes truth(128, 128, 3, 0.5f), features = FlatFeatures(128, 128);
    const NoisyPicture noisy = AddNoise(truth, features, 0.1, 4);
    const Planes variance(128, 128, 3, 0.01f);
    const Planes result = Regress(noisy.colour.a, features, {noisy.colour.b, variance})[1];
    EXPECT_LT(Rms(result, truth), 0.1 / 8);
    EXPECT_NEAR(SumOf(result) / SumOf(noisy.colour.a), 1, 1e-3);
}

// Half of the fits nearly suffice, and no pixel goes without.
TEST(Regression, FitsOverlap) {
    const Planes truth =
        MakePlanes(128, 128, 3, [](int, int x, int y) { return x == 63 && y % 7 == 0 ? 5 : 0.5; });
    const Planes features = FlatFeatures(128, 128);
    const NoisyPicture noisy = AddNoise(truth, features, 0.1, 4);
    const Planes variance(128, 128, 3, 0.01f);
    const PatchGuide guide{noisy.colour.b, variance};
    const Planes all = Regress(noisy.colour.a, features, guide)[1];
    const Planes half = Regress(noisy.colour.a, features, guide, 2)[1];
    EXPECT_NE(all.values, half.values);
    EXPECT_LT(Rms(half, truth), 1.1 * Rms(all, truth));
    for (const int y : {35, 49, 56, 63}) EXPECT_NEAR(half.Row(1, y)[63], 5, 0.5);
}

// Weights that come from the other half end at an edge that features do not know of.
TEST(Regression, KeepsEdgesThatTheGuideSees) {
    const Planes truth = MakePlanes(100, 60, 3, [](int, int x, int) { return x < 50 ? 0.2 : 0.8; });
    const Planes features = FlatFeatures(100, 60);
    const NoisyPicture noisy = AddNoise(truth, features, 0.02, 5);
    const Planes variance(100, 60, 3, 0.0004f);
    const Planes result = Regress(noisy.colour.a, features, {noisy.colour.b, variance})[0];
    EXPECT_LT(Rms(result, truth), 0.01);
}

}  // namespace
}  // namespace lull
