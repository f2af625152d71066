#include "stopping/rules/lnoise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

#include "stopping/base/block_view.h"
#include "stopping/rules/rule_table.h"
#include "tests/stopping/signals/block_images.h"

namespace lull {
namespace {

// Returns an even grey block whose halves differ so that the noise in L of every pixel is `noise`.
BlockImage EvenNoise(double noise, int width = 40, int height = 40) {
    const double y = 0.3, slope = 116 / 3.0 * std::pow(y, -2 / 3.0);
    BlockImage image(width, height, float(y));
    for (float& v : image.halfMean) v = float(y + noise / slope);
    return image;
}

TEST(LNoise, PoolsSubBlocks) {
    EXPECT_EQ(PooledRms(std::vector<float>{3}), 3);
    EXPECT_NEAR(PooledRms(std::vector<float>{1, 2, 0, 2}), 1.5, 1e-12);
}

TEST(LNoise, IsTheRmsOverTheBlock) {
    EXPECT_NEAR(VisibleNoise(EvenNoise(0.5).At(20)), 0.5, 1e-4);

    // Half of the block has no noise: the mean square halves.
    BlockImage half = EvenNoise(0.5);
    std::fill_n(half.halfMean.begin(), half.halfMean.size() / 2, half.mean[0]);
    EXPECT_NEAR(VisibleNoise(half.At(20)), 0.5 / std::sqrt(2.0), 1e-4);

    // A mosaic of 10 pixels, with L = 0 and 61.7, masks noise on it: t is nowhere above 30.9.
    BlockImage mosaic = EvenNoise(0.5);
    for (int y = 0; y < 40; ++y)
        for (int x = 0; x < 40; ++x)
            if ((x / 10 + y / 10) % 2) {
                std::fill_n(mosaic.Mean(x, y), 3, 0.f);
                std::fill_n(mosaic.HalfMean(x, y), 3, 0.f);
            }
    const double visible = VisibleNoise(mosaic.At(20));
    EXPECT_LT(visible, 0.5 / std::sqrt(2.0) / (1 + 10 / 4.0));
    EXPECT_GT(visible, 0.5 / std::sqrt(2.0) / (1 + 30.9 / 4.0));
}

TEST(LNoise, FallsWithTheRootOfTheSamples) {
    const double at20 = VisibleNoise(NoisyBlock(200, 200, 0.2, 20, 1).At(20));
    const double at320 = VisibleNoise(NoisyBlock(200, 200, 0.2, 320, 2).At(320));
    EXPECT_NEAR(at20 / at320, 4, 0.2);
}

TEST(LNoise, StopsAfterThreeVotesInARow) {
    const auto criterion = MakeCriterion(LightnessNoiseRule(0.5));
    EXPECT_EQ(criterion->Need(20), ViewNeed::MeanAndHalf);
    const double noise[] = {0.9, 0.4, 0.4, 0.6, 0.4, 0.4, 0.4};
    const int votes[] = {0, 1, 2, 0, 1, 2, 3};
    for (int i = 0; i < 7; ++i) {
        const Decision decision = criterion->Observe(EvenNoise(noise[i]).At(20 * (i + 1)));
        EXPECT_TRUE(decision.checked);
        EXPECT_NEAR(decision.value, noise[i], 1e-4);
        EXPECT_EQ(decision.threshold, 0.5);
        EXPECT_EQ(decision.votes, votes[i]);
        EXPECT_EQ(decision.stop, i == 6);
    }
}

TEST(LNoise, GoesOnCountingAfterARestart) {
    const auto first = MakeCriterion(LightnessNoiseRule(0.5)),
               second = MakeCriterion(LightnessNoiseRule(0.5));
    for (int i = 1; i <= 2; ++i) first->Observe(EvenNoise(0.4).At(20 * i));
    second->Restore(first->Save());
    EXPECT_EQ(second->Save(), first->Save());
    EXPECT_TRUE(second->Observe(EvenNoise(0.4).At(60)).stop);

    EXPECT_THROW(second->Restore({}), std::runtime_error);
    std::vector<std::byte> state = first->Save();
    state.back() = std::byte(0xff);  // a negative count
    EXPECT_THROW(second->Restore(state), std::runtime_error);
    EXPECT_THROW(MakeCriterion(ParseRule("cycles:0.1"))->Restore(first->Save()),
                 std::runtime_error);
}

TEST(LNoise, IsARule) {
    const Rule rule = ParseRule("lnoise:0.5");
    EXPECT_EQ(rule.text, "lnoise:0.5");
    EXPECT_EQ(rule.smallestSide, kSmallestVotingSide);
    EXPECT_EQ(MakeCriterion(rule)->Observe(EvenNoise(0.4).At(20)).threshold, 0.5);
}

TEST(LNoise, RefusesWhatItCannotMeasure) {
    BlockImage image = EvenNoise(0.4);
    BlockView view = image.At(20);
    view.halfMean = {};
    EXPECT_THROW(MakeCriterion(LightnessNoiseRule(1))->Observe(view), std::invalid_argument);
    EXPECT_THROW(VisibleNoise(EvenNoise(0.4, 9, 40).At(20)), std::invalid_argument);

    image.mean.assign(image.mean.size(), std::numeric_limits<float>::quiet_NaN());
    EXPECT_TRUE(std::isfinite(VisibleNoise(image.At(20))));
}

}  // namespace
}  // namespace lull
