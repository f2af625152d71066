#include "renderer/progress/forecast.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

namespace lull {
namespace {

constexpr double kThreshold = 0.8;

// Shows a trend the values of `value` in passes of 20 spp up to `end`.
StopTrend Follow(const RuleTrend& rule, int end, const std::function<double(int spp)>& value,
                 double threshold = kThreshold) {
    StopTrend trend(rule);
    for (int spp = 20; spp <= end; spp += 20)
        trend.Add(spp, {.checked = true, .value = value(spp), .threshold = threshold});
    return trend;
}

std::vector<Block> LiveBlocks(std::span<const StopTrend> trends) {
    std::vector<Block> blocks;
    for (const StopTrend& trend : trends)
        blocks.push_back({.pixels = {{0, 0}, {10, 10}}, .spp = trend.LastSpp()});
    return blocks;
}

double PredictOne(const StopTrend& trend, int cap = 10000) {
    return PredictStops({&trend, 1}, LiveBlocks({&trend, 1}), cap).value().at(0);
}

// The value falls to the threshold at 4000 spp, with any power, and some noise of its own.
TEST(PredictStops, FollowsAPowerOfTheSamples) {
    for (const double power : {0.3, 0.5, 0.75, 1.0}) {
        std::mt19937 generator(7);
        std::normal_distribution<double> gauss(0, 0.03);
        const auto value = [&](int spp) {
            return kThreshold * std::pow(4000.0 / spp, power) * std::exp(gauss(generator));
        };
        EXPECT_NEAR(PredictOne(Follow({}, 1000, value)), 4000, 600) << power;
        EXPECT_NEAR(PredictOne(Follow({}, 2000, value)), 4000, 300) << power;
        EXPECT_NEAR(PredictOne(Follow({}, 3000, value)), 4000, 150) << power;
    }
}

TEST(PredictStops, BearsSinglePassesThatAreFarOff) {
    const auto value = [](int spp) {
        const double clean = kThreshold * std::sqrt(2000.0 / spp);
        return spp % 700 == 0 ? 50 * clean : spp % 260 == 0 ? 0 : clean;
    };
    EXPECT_NEAR(PredictOne(Follow({}, 600, value)), 2000, 300);
    EXPECT_NEAR(PredictOne(Follow({}, 1400, value)), 2000, 150);
}

TEST(PredictStops, StaysBetweenNowAndTheCap) {
    // It does not fall at all, or is below the threshold, or nonsense.
    EXPECT_EQ(PredictOne(Follow({}, 1000, [](int) { return 9.0; }), 2000), 2000);
    EXPECT_EQ(PredictOne(Follow({}, 1000, [](int) { return 0.1; })), 1000);
    EXPECT_EQ(PredictOne(Follow({}, 1000, [](int spp) { return spp * 1.0; }), 2000), 2000);
    for (const double nonsense : {0.0, std::numeric_limits<double>::infinity(), 1e300}) {
        const double stop = PredictOne(Follow({}, 1000, [=](int) { return nonsense; }), 2000);
        EXPECT_GE(stop, 1000);
        EXPECT_LE(stop, 2000);
    }
}

// After the first pass nothing is known but that noise falls with the root of the samples.
TEST(PredictStops, BeginsWithTheUsualPower) {
    EXPECT_NEAR(PredictOne(Follow({}, 20, [](int) { return 4 * kThreshold; })), 320, 1);
    EXPECT_FALSE(PredictStops(std::vector{StopTrend()}, LiveBlocks(std::vector{StopTrend()}), 99));
}

// A known power counts, not the slope of the block's own values.
TEST(PredictStops, FollowsAKnownPower) {
    const RuleTrend rule{.power = -0.75};
    for (const double shown : {0.0, 0.2, 2.0}) {
        const auto value = [=](int spp) { return 2 * kThreshold * std::pow(1000.0 / spp, shown); };
        EXPECT_NEAR(PredictOne(Follow(rule, 1000, value)), 1000 * std::pow(2, 1 / 0.75), 30)
            << shown;
    }
}

// The odds of a network fall as a power, too, but nobody knows which; and it is certain at first.
TEST(PredictStops, FollowsTheOddsOfAProbability) {
    const RuleTrend rule{.kind = RuleTrend::Probability, .votes = 1};
    const auto value = [](int spp) { return 1 / (1 + std::pow(spp / 3000.0, 6)); };
    EXPECT_NEAR(PredictOne(Follow(rule, 1500, value, 0.5)), 3000, 250);
    EXPECT_NEAR(PredictOne(Follow(rule, 2500, value, 0.5)), 3000, 60);
    // Where it is still certain, what others have shown helps.
    const std::vector<StopTrend> trends = {
        Follow(
            rule, 1500, [](int spp) { return 1 / (1 + std::pow(spp / 1600.0, 6)); }, 0.5),
        Follow(
            rule, 1500, [](int) { return 1.0; }, 0.5)};
    const auto stops = PredictStops(trends, LiveBlocks(trends), 20000).value();
    EXPECT_NEAR(stops[0], 1600, 60);
    EXPECT_GT(stops[1], 5000);
    EXPECT_LE(stops[1], 20000);
    const StopTrend certain = Follow(
        rule, 1500, [](int) { return 1.0; }, 0.5);
    EXPECT_FALSE(PredictStops({&certain, 1}, LiveBlocks({&certain, 1}), 20000));
}

// What is visible against a picture at 10,000 spp is gone there.
TEST(PredictStops, KnowsWhatNoiseIsComparedWith) {
    const RuleTrend rule{.reference = 10000};
    const auto value = [](int spp) {
        const double fall = (1.0 / spp - 1e-4) / (1.0 / 6000 - 1e-4);
        return kThreshold * std::sqrt(std::max(fall, 0.0));
    };
    for (const int end : {200, 1000, 4000})
        EXPECT_NEAR(PredictOne(Follow(rule, end, value), 20000), 6000, 10) << end;
    EXPECT_GT(PredictOne(Follow({}, 1000, value), 20000), 7500);
    EXPECT_EQ(PredictOne(Follow(rule, 12000, value), 20000), 12000);
}

// A number that falls with an ever larger power is followed on the way to the power 1/2.
TEST(PredictStops, FollowsWhatSaturates) {
    const auto value = [](int spp) {
        const double noise = kThreshold * std::sqrt(3000.0 / spp);
        return noise * (1 + 0.05 * kThreshold) / (1 + 0.05 * noise);
    };
    for (const int end : {200, 750, 1500}) {
        const double stop = PredictOne(Follow({.saturates = true}, end, value));
        EXPECT_NEAR(stop, 3000, 150) << end;
        EXPECT_GT(PredictOne(Follow({}, end, value)) - 3000, 2 * std::abs(stop - 3000)) << end;
    }
}

// A network's answer is as good as certain for long, but not the noise that it looks at.
TEST(PredictStops, FollowsTheNoiseThatANetworkLooksAt) {
    StopTrend trend({.kind = RuleTrend::Probability, .votes = 1, .undecided = 0.7});
    EXPECT_EQ(trend.IsOfOdds(), false);
    for (int spp = 20; spp <= 400; spp += 20)
        trend.Add(spp, {.checked = true, .value = 1, .threshold = 0.5},
                  0.7 * std::sqrt(2500.0 / spp));
    EXPECT_NEAR(PredictOne(trend), 2500, 20);
    // One from a checkpoint has no noise.
    trend.Add(420, {.checked = true, .value = 1, .threshold = 0.5});
    EXPECT_EQ(trend.LastSpp(), 400);
}

// A factor of the noise near its reference that falls as (1 - n / N)^x is followed for any x.
TEST(PredictStops, FollowsTheNearnessOfAReference) {
    for (const double x : {0.25, 0.5, 1.}) {
        const RuleTrend rule{.reference = 10000, .nearness = x};
        const auto fall = [&](int spp) { return std::pow(1 - spp / 10000., x) / std::sqrt(spp); };
        const auto value = [&](int spp) { return kThreshold * fall(spp) / fall(7000); };
        for (const int end : {200, 3000})
            EXPECT_NEAR(PredictOne(Follow(rule, end, value)), 7000, 10) << x << " " << end;
    }
}

TEST(RangeOfRest, HoldsThePredictionAndNarrowsTowardsTheEnd) {
    double last = 1e9;
    for (const double left : {20000., 2000., 200., 20.}) {
        const auto [least, most] = RangeOfRest(1000, left, RuleTrend().exponents);
        EXPECT_GT(least, 0);
        EXPECT_LT(least, left);
        EXPECT_GT(most, left);
        EXPECT_LT(most / least, last);
        last = most / least;
    }
    EXPECT_EQ(RangeOfRest(1000, 0, {0.5, 2}), (std::array<double, 2>{0, 0}));
    EXPECT_EQ(RangeOfRest(1, 3, {0.5, 2}), (std::array<double, 2>{1, 15}));
}

TEST(PredictStops, CountsTheVotesThatAreMissing) {
    const RuleTrend rule{.kind = RuleTrend::Error, .votes = 3};
    const auto value = [](int spp) { return kThreshold * std::sqrt(2000.0 / spp); };
    EXPECT_NEAR(PredictOne(Follow(rule, 1000, value)), 2040, 20);
    StopTrend trend = Follow(rule, 2000, value);
    trend.Add(2020, {.checked = true, .value = 0.7, .threshold = kThreshold, .votes = 2});
    EXPECT_EQ(trend.VotesLeft(), 0);
}

TEST(PredictStops, KnowsWhereSamplesAreCounted) {
    const RuleTrend rule{.kind = RuleTrend::Samples};
    const StopTrend trend = Follow(
        rule, 40, [](int spp) { return double(spp); }, 640);
    EXPECT_EQ(PredictOne(trend), 640);
    EXPECT_EQ(PredictOne(trend, 100), 100);
}

TEST(PredictStops, LetsFollowersStopWithTheirLeader) {
    std::vector<StopTrend> trends(4);
    trends[0] = Follow({}, 1000, [](int spp) { return kThreshold * std::sqrt(1600.0 / spp); });
    std::vector<Block> blocks = LiveBlocks(trends);
    blocks[1].votes = blocks[2].votes = false;
    blocks[1].leader = 0;
    blocks[3].spp = 700;
    blocks[3].stopped = true;
    const auto stops = PredictStops(trends, blocks, 10000).value();
    EXPECT_NEAR(stops[0], 1600, 30);
    EXPECT_EQ(stops[1], stops[0]);
    EXPECT_EQ(stops[2], 10000);  // nobody stops it
    EXPECT_EQ(stops[3], 700);
}

}  // namespace
}  // namespace lull
