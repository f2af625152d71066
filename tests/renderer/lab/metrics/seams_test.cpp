#include "renderer/lab/metrics/seams.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace lull {
namespace {

const std::vector<PixelRect> kBlocks = {
    {{0, 0}, {100, 100}}, {{100, 0}, {200, 100}}, {{0, 100}, {100, 200}}, {{100, 100}, {200, 200}}};

// Makes noise of deviation `left` in the left half, `right` in the other; 200 x 200 pixels.
std::vector<float> Noise(float left, float right) {
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    std::vector<float> noise;
    for (int i = 0; i < 200 * 200; ++i)
        noise.push_back(normal(random) * (i % 200 < 100 ? left : right));
    return noise;
}

TEST(MeasureSeams, SeesNoBorderInEvenNoise) {
    const Seams seams = MeasureSeams(Noise(1, 1), 200, kBlocks);
    EXPECT_NEAR(seams.Ratio(), 1, 0.35);
    EXPECT_LT(seams.border, 0.1);
}

// One of the two kinds of borders, of the same length, has a jump of 2; the other has none.
TEST(MeasureSeams, SeesWhereTheNoiseJumps) {
    const Seams seams = MeasureSeams(Noise(1, 3), 200, kBlocks);
    EXPECT_NEAR(seams.border, 1, 0.1);
    EXPECT_GT(seams.Ratio(), 5);
}

TEST(MeasureSeams, GrowsWithTheNoise) {
    const Seams one = MeasureSeams(Noise(1, 3), 200, kBlocks),
                two = MeasureSeams(Noise(2, 6), 200, kBlocks);
    EXPECT_NEAR(two.border, 2 * one.border, 1e-5);
    EXPECT_NEAR(two.Ratio(), one.Ratio(), 1e-5);
}

TEST(MeasureSeams, KnowsNoRatioWithoutBordersOrNoise) {
    const std::vector<PixelRect> whole = {{{0, 0}, {200, 200}}};
    EXPECT_TRUE(std::isnan(MeasureSeams(Noise(1, 1), 200, whole).Ratio()));
    EXPECT_TRUE(std::isnan(MeasureSeams(Noise(0, 0), 200, kBlocks).Ratio()));
}

TEST(MeasureSeams, LeavesOutBlocksThatAreTooNarrow) {
    const std::vector<PixelRect> blocks = {{{0, 0}, {195, 200}}, {{195, 0}, {200, 200}}};
    EXPECT_EQ(MeasureSeams(Noise(1, 3), 200, blocks).border, 0);
}

}  // namespace
}  // namespace lull
