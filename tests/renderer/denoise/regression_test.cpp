#include "renderer/denoise/denoise.h"

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
    EXPECT_LT(Rms(Regress(noisy.colour.a, features, {noisy.colour.b, variance})[0], truth), 0.01);
}

TEST(Planes, AreFilteredByBoxes) {
    const Planes image = MakePlanes(
        7, 5, 2, [](int c, int x, int y) { return c == 0 ? x * x + 10 * y : (x == 3 && y == 2); });
    const Planes sum = BoxSum(image, 2), mean = BoxMean(image, 2);
    for (int c = 0; c < 2; ++c)
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 7; ++x) {
                double expected = 0;
                int count = 0;
                for (int v = std::max(0, y - 2); v <= std::min(4, y + 2); ++v)
                    for (int u = std::max(0, x - 2); u <= std::min(6, x + 2); ++u, ++count)
                        expected += image.Row(c, v)[u];
                EXPECT_FLOAT_EQ(sum.Row(c, y)[x], float(expected));
                EXPECT_FLOAT_EQ(mean.Row(c, y)[x], float(expected / count));
            }
}

// What a bright value adds to a running sum has to go again without a trace.
TEST(Planes, AreNotSpoiledByBrightValues) {
    Planes image(64, 64, 1, 1e-3f);
    image.Row(0, 10)[10] = 1e8f;
    const Planes mean = BoxMean(image, 3);
    EXPECT_FLOAT_EQ(mean.Row(0, 50)[10], 1e-3f);
    EXPECT_FLOAT_EQ(mean.Row(0, 10)[50], 1e-3f);
}

// Pictures are filtered part by part.
TEST(Planes, AreFilteredAlikeInParts) {
    std::mt19937 generator(1);
    std::normal_distribution<double> gauss(0, 1);
    const Planes image = MakePlanes(50, 40, 1, [&](int, int, int) { return gauss(generator); });
    const Planes part = Crop(image, {9, 7, 45, 40});
    EXPECT_EQ(Crop(BoxMean(image, 4), {13, 11, 41, 40}).values,
              Crop(BoxMean(part, 4), {4, 4, 32, 33}).values);
}

TEST(Planes, VaryByHalfTheirSquaredDifference) {
    Planes a(3, 2, 2, 1), b(3, 2, 2, 1);
    b.Row(1, 1)[2] = -3;
    Planes expected(3, 2, 2);
    expected.Row(1, 1)[2] = 8;
    EXPECT_EQ(VarianceOf(a, b).values, expected.values);
}

}  // namespace
}  // namespace lull
