#include "stopping/lab/evaluation/certainty.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>
#include <string>

#include "stopping/network/human_range.h"

namespace lull {
namespace {

ViewpointOutcome Viewpoint(const std::vector<std::pair<int, int>>& humanAndStop) {
    ViewpointOutcome viewpoint{.name = "a"};
    for (const auto& [human, stop] : humanAndStop)
        viewpoint.blocks.push_back({human, {.stop = stop}});
    return viewpoint;
}

TEST(LogRatioQuantiles, AreThoseOfTheRatios) {
    std::vector<std::pair<int, int>> blocks;
    for (int i = -50; i <= 50; ++i)
        blocks.emplace_back(int(std::lround(100000 * std::exp(i / 50.0))), 100000);
    const std::vector<double> q = LogRatioQuantiles(std::vector{Viewpoint(blocks)});
    ASSERT_EQ(q.size(), size_t(kLogRatios));
    for (int i = 0; i < kLogRatios; ++i) EXPECT_NEAR(q[size_t(i)], -1 + i / 5.0, 0.011) << i;
    EXPECT_TRUE(std::ranges::is_sorted(q));
}

TEST(LogRatioQuantiles, LetEachViewpointCountTheSame) {
    // Nine blocks of one stop early, a single one of the other stops late.
    const std::vector<ViewpointOutcome> viewpoints = {
        Viewpoint(std::vector<std::pair<int, int>>(9, {2000, 1000})), Viewpoint({{1000, 2000}})};
    const std::vector<double> q = LogRatioQuantiles(viewpoints);
    EXPECT_NEAR(q[1], -std::log(2), 1e-12);
    EXPECT_NEAR(q[9], std::log(2), 1e-12);
    EXPECT_NEAR(LogRatioQuantiles(std::span(viewpoints).last(1))[9], -std::log(2), 1e-12);
    EXPECT_THROW(LogRatioQuantiles({}), std::invalid_argument);
}

TEST(RangeOfPeople, IsInSamples) {
    std::vector<double> ratios;
    for (int i = 0; i < kLogRatios; ++i) ratios.push_back((i - 5) * std::log(2.0) / 4);
    HumanRange range = RangeOfPeople(1000, true, ratios);
    EXPECT_EQ(range.low, 500);
    EXPECT_EQ(range.high, 2000);
    // Thresholds beyond the pictures shown are unknown, and so are stops that have not occurred.
    EXPECT_FALSE(RangeOfPeople(6000, true, ratios).high);
    EXPECT_EQ(RangeOfPeople(6000, true, ratios).low, 3000);
    EXPECT_FALSE(RangeOfPeople(1000, false, ratios).high);
    EXPECT_EQ(RangeOfPeople(1, true, ratios).low, 1);
    EXPECT_EQ(RangeOfPeople(1 << 24, true, ratios).low, kMostShownSpp);
}

// Thresholds that scatter about the stops in the same way everywhere lie in the range as often as
// it says; if one viewpoint is another matter, fewer do.
TEST(RangeCoverage, IsWhatItClaims) {
    std::mt19937 generator(5);
    std::normal_distribution<double> gauss(0.2, 0.3);
    std::vector<ViewpointOutcome> viewpoints;
    for (int v = 0; v < 4; ++v) {
        std::vector<std::pair<int, int>> blocks;
        for (int i = 0; i < 2000; ++i)
            blocks.emplace_back(int(2000 * std::exp(gauss(generator))), 2000);
        viewpoints.push_back(Viewpoint(blocks));
    }
    EXPECT_NEAR(RangeCoverage(viewpoints), 0.8, 0.03);  // 8000 draws: 3 sigma are 0.013
    for (BlockOutcome& block : viewpoints[0].blocks) block.human *= 3;
    EXPECT_LT(RangeCoverage(viewpoints), 0.75);
    EXPECT_THROW(RangeCoverage(std::span(viewpoints).first(1)), std::invalid_argument);
    // All that people put at the cap is in a range without an upper end.
    const std::vector<ViewpointOutcome> atCap = {Viewpoint({{10000, 9500}, {10000, 10000}}),
                                                 Viewpoint({{10000, 9500}, {10000, 10000}})};
    EXPECT_EQ(RangeCoverage(atCap), 1);
}

}  // namespace
}  // namespace lull
