#include "stopping/rules/baselines.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "stopping/base/block_view.h"
#include "stopping/rules/rule_table.h"
#include "tests/stopping/signals/block_images.h"

namespace lull {
namespace {

TEST(HalfBuffers, DifferByTheStandardErrorOfTheMean) {
    // Samples of deviation 0.5: |I - A| of a pixel has the mean sqrt(2 / pi) * 0.5 / sqrt(n).
    const int n = 40, pixels = 20000;
    std::mt19937 generator(3);
    std::normal_distribution<double> sample(2, 0.5);
    double sum = 0, sumOfSquares = 0;
    for (int p = 0; p < pixels; ++p) {
        double all = 0, half = 0;
        for (int k = 0; k < n; ++k) {
            const double x = sample(generator);
            all += x;
            if (k % 2) half += x;
        }
        const double difference = all / n - half / (n / 2);
        sum += std::abs(difference);
        sumOfSquares += difference * difference;
    }
    const double standardError = 0.5 / std::sqrt(double(n));
    EXPECT_NEAR(std::sqrt(sumOfSquares / pixels) / standardError, 1, 0.02);
    EXPECT_NEAR(sum / pixels / standardError, std::sqrt(2 / M_PI), 0.02);
}

TEST(Fixed, StopsAtTheEndOfThePassThatReachesIt) {
    const auto criterion = MakeCriterion(FixedRule(50));
    EXPECT_EQ(criterion->Need(40), ViewNeed::Nothing);
    const BlockView view = {.width = 8, .height = 8};
    for (int spp : {20, 40, 60}) {
        BlockView now = view;
        now.spp = spp;
        const Decision decision = criterion->Observe(now);
        EXPECT_EQ(decision.stop, spp == 60);
        EXPECT_EQ(decision.value, spp);
        EXPECT_EQ(decision.threshold, 50);
    }
}

TEST(Dammertz, AveragesTheRelativeErrors) {
    BlockImage image(2, 1, 0);
    // s = 0.25 and d = 0.05, so that e = 0.1; the other pixel is black and counts as 0.
    const float mean[3] = {0.1f, 0.1f, 0.05f}, half[3] = {0.12f, 0.09f, 0.07f};
    std::copy(mean, mean + 3, image.Mean(0, 0));
    std::copy(half, half + 3, image.HalfMean(0, 0));
    EXPECT_NEAR(DammertzError(image.At(20)), 0.05, 1e-7);

    EXPECT_FALSE(MakeCriterion(DammertzRule(0.0499))->Observe(image.At(20)).stop);
    EXPECT_TRUE(MakeCriterion(DammertzRule(0.0501))->Observe(image.At(20)).stop);
    EXPECT_NEAR(
        MakeCriterion(DammertzRule(1, true), {.areaFraction = 0.0625})->Observe(image.At(20)).value,
        0.0125, 1e-7);
    EXPECT_EQ(MakeCriterion(DammertzRule(1))->Need(20), ViewNeed::MeanAndHalf);
}

TEST(Cycles, HasTheKnownMinima) {
    EXPECT_EQ(CyclesMinimumSpp(0.1), 32);
    EXPECT_EQ(CyclesMinimumSpp(0.01), 64);
    EXPECT_EQ(CyclesMinimumSpp(0.001), 128);
    EXPECT_EQ(CyclesMinimumSpp(1e6), 4);
    EXPECT_GT(CyclesMinimumSpp(1e-300), 1000000);

    // The first test comes after sample index 64, so with more than 65 samples.
    const auto criterion = MakeCriterion(CyclesRule(0.01));
    for (int spp : {20, 40, 60, 65, 70, 90}) EXPECT_EQ(criterion->Need(spp), ViewNeed::Nothing);
    for (int spp : {80, 100, 1000}) EXPECT_EQ(criterion->Need(spp), ViewNeed::MeanAndHalf);
    EXPECT_EQ(MakeCriterion(CyclesRule(0.001))->Need(140), ViewNeed::MeanAndHalf);
    EXPECT_EQ(MakeCriterion(CyclesRule(0.001))->Need(120), ViewNeed::Nothing);
}

TEST(Cycles, DividesByTheRootOrTheSum) {
    const float dark[3] = {0.1f, 0.1f, 0.05f}, darkHalf[3] = {0.12f, 0.09f, 0.07f};
    EXPECT_NEAR(CyclesPixelError(dark, darkHalf), 0.05 / 0.5001, 1e-7);
    const float bright[3] = {1, 2, 1}, brightHalf[3] = {1.5f, 2, 1.25f};
    EXPECT_NEAR(CyclesPixelError(bright, brightHalf), 0.75 / 4.0001, 1e-7);
    const float black[3] = {0, 0, 0};
    EXPECT_EQ(CyclesPixelError(black, black), 0);
}

// Makes the pixel's error 2 * 0.01 / 0.5001 (d = 0.02), which fails a threshold of 0.001 (0.005).
void MakeNoisy(BlockImage* image, int x, int y, bool noisy) {
    image->HalfMean(x, y)[0] = image->Mean(x, y)[0] + (noisy ? 0.02f : 0);
}

TEST(Cycles, StopsWhenNoPixelIsActive) {
    BlockImage image(7, 5, 0.25f / 3);
    const auto criterion = MakeCriterion(CyclesRule(0.001));
    Decision decision = criterion->Observe(image.At(20));
    EXPECT_FALSE(decision.checked || decision.stop);

    MakeNoisy(&image, 3, 2, true);
    decision = criterion->Observe(image.At(140));
    EXPECT_TRUE(decision.checked);
    EXPECT_FALSE(decision.stop);
    EXPECT_NEAR(decision.value, 0.02 / 0.5001 / 5, 1e-6);
    // Far from an active pixel, new noise is no longer seen; among its neighbours it is.
    MakeNoisy(&image, 3, 2, false);
    MakeNoisy(&image, 5, 2, true);
    EXPECT_TRUE(criterion->Observe(image.At(160)).stop);
}

TEST(Cycles, ActivatesTheNeighboursAgain) {
    for (int y = 0; y < 5; ++y)
        for (int x = 0; x < 7; ++x) {
            BlockImage image(7, 5, 0.25f / 3);
            const auto criterion = MakeCriterion(CyclesRule(0.001));
            MakeNoisy(&image, 3, 2, true);
            criterion->Observe(image.At(140));
            MakeNoisy(&image, 3, 2, false);
            MakeNoisy(&image, x, y, true);
            const bool isNeighbour = std::abs(x - 3) <= 1 && std::abs(y - 2) <= 1;
            EXPECT_EQ(criterion->Observe(image.At(160)).stop, !isNeighbour) << x << ", " << y;
        }
}

TEST(LuxTile, TakesTheLargestDisplayDifference) {
    BlockImage image(4, 3, 0.5f);
    image.HalfMean(2, 1)[1] = 0.45f;
    image.Mean(0, 0)[2] = 7;  // both beyond white: not seen
    image.HalfMean(0, 0)[2] = 1;
    const double expected = std::pow(0.5, 1 / 2.2) - std::pow(0.45, 1 / 2.2);
    EXPECT_NEAR(LuxTileError(image.At(40)), expected, 1e-6);

    const auto criterion = MakeCriterion(LuxTileRule(6 / 256.0));
    EXPECT_EQ(criterion->Need(20), ViewNeed::Nothing);
    EXPECT_FALSE(criterion->Observe(image.At(20)).checked);
    EXPECT_FALSE(criterion->Observe(image.At(40)).stop);
    image.HalfMean(2, 1)[1] = 0.48f;
    EXPECT_TRUE(criterion->Observe(image.At(60)).stop);
}

TEST(Baselines, LeaveNoNan) {
    const float values[] = {0,
                            -1,
                            1e30f,
                            3.4e38f,
                            std::numeric_limits<float>::quiet_NaN(),
                            1e-38f,
                            std::numeric_limits<float>::infinity()};
    for (float mean : values)
        for (float half : values) {
            BlockImage image(4, 4, mean);
            image.halfMean.assign(image.mean.size(), half);
            for (const auto& criterion :
                 {MakeCriterion(DammertzRule(0.01)), MakeCriterion(CyclesRule(0.1)),
                  MakeCriterion(LuxTileRule(0.1))}) {
                const Decision decision = criterion->Observe(image.At(40));
                EXPECT_TRUE(decision.checked);
                EXPECT_TRUE(std::isfinite(decision.value)) << mean << ", " << half;
            }
        }
}

TEST(Baselines, RefuseViewsWithoutPixels) {
    const BlockImage image(4, 4, 1);
    BlockView view = image.At(80);
    view.halfMean = {};
    for (const auto& criterion : {MakeCriterion(DammertzRule(0.01)), MakeCriterion(CyclesRule(0.1)),
                                  MakeCriterion(LuxTileRule(0.1))})
        EXPECT_THROW(criterion->Observe(view), std::invalid_argument);
    EXPECT_THROW(MakeCriterion(FixedRule(20))->Observe({}), std::invalid_argument);

    const auto cycles = MakeCriterion(CyclesRule(0.1));
    cycles->Observe(image.At(80));
    const BlockImage other(8, 2, 1);
    EXPECT_THROW(cycles->Observe(other.At(100)), std::invalid_argument);
}

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
    EXPECT_NEAR(at20 / VisibleNoise(NoisyBlock(200, 200, 0.2, 320, 2).At(320)), 4, 0.2);
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
