#include "stopping/lab/evaluation/evaluation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "stopping/rules/thresholds.h"
#include "tests/stopping/golden_data.h"

namespace lull {
namespace {

double ErrorOf(int human, int stop, double margin, int grid) {
    const BlockOutcome block{.human = human, .outcome = {.stop = stop}};
    return CriticalError({&block, 1}, margin, grid);
}

TEST(CriticalError, CountsTheSppThatAreWrong) {
    // 2 % of 10,000 spp are 100 below and above. Of the 500 spp of grid 20, 820 to 900 are wrong
    // where the stop is at 800, and 1100 to 1180 where it is at 1200.
    EXPECT_EQ(ErrorOf(1000, 1000, 2, 20), 0);
    EXPECT_EQ(ErrorOf(1000, 900, 2, 20), 0);
    EXPECT_EQ(ErrorOf(1000, 1100, 2, 20), 0);
    EXPECT_DOUBLE_EQ(ErrorOf(1000, 800, 2, 20), 5 / 500.0);
    EXPECT_DOUBLE_EQ(ErrorOf(1000, 1200, 2, 20), 5 / 500.0);
    EXPECT_EQ(ErrorOf(1000, 800, 6, 20), 0);
    // Grid 40 has 20, 60, ..., 9980: 820, 860 and 900; 1100, 1140 and 1180.
    EXPECT_DOUBLE_EQ(ErrorOf(1000, 800, 2, 40), 3 / 250.0);
    EXPECT_DOUBLE_EQ(ErrorOf(1000, 1200, 2, 40), 3 / 250.0);
    // Without a margin, only the threshold itself is right on both sides.
    EXPECT_DOUBLE_EQ(ErrorOf(1000, 940, 0, 20), 2 / 500.0);
    // A margin of 1 % is 50 spp, two passes.
    EXPECT_DOUBLE_EQ(ErrorOf(1000, 900, 1, 20), 3 / 500.0);
}

TEST(CriticalError, HasNoMarginWherePeopleSawNoiseAtTheCap) {
    EXPECT_EQ(ErrorOf(10000, 10000, 10, 20), 0);
    EXPECT_DOUBLE_EQ(ErrorOf(10000, 9000, 2, 20), 49 / 500.0);  // 9020 to 9980
    EXPECT_DOUBLE_EQ(ErrorOf(10000, 9000, 10, 20), 49 / 500.0);
    EXPECT_DOUBLE_EQ(ErrorOf(10000, 0, 2, 40), 1);
    EXPECT_DOUBLE_EQ(ErrorOf(20, 10000, 0, 40), 249 / 250.0);
}

TEST(CriticalError, IsTheMeanOverBlocks) {
    const std::vector<BlockOutcome> blocks = {{1000, {.stop = 1000}}, {1000, {.stop = 800}}};
    EXPECT_DOUBLE_EQ(CriticalError(blocks, 2, 20), 2.5 / 500);
    EXPECT_EQ(CriticalError({}, 2, 20), 0);
}

TEST(CriticalError, IsThePublishedOne) {
    const std::vector<ThresholdsRow> human = ReadThresholds(ThresholdsFile("human.csv"));
    const struct {
        const char* file;
        int grid;
        double percent[3];
    } published[] = {{"svd-entropy-rnn.csv", 40, {14.79, 13.25, 11.89}},
                     {"26-attributes-rnn.csv", 20, {17.82, 16.205, 14.73}}};
    for (const auto& [file, grid, percent] : published) {
        std::vector<ViewpointOutcome> viewpoints;
        for (const ThresholdsRow& row : ReadThresholds(ThresholdsFile(file))) {
            const auto people = std::ranges::find(human, row.name, &ThresholdsRow::name);
            if (people == human.end()) continue;
            viewpoints.push_back({.name = row.name});
            for (size_t i = 0; i < row.spp.size(); ++i)
                viewpoints.back().blocks.push_back({people->spp[i], {.stop = row.spp[i]}});
        }
        const Scores scores = Score(viewpoints, {.grid = grid});
        EXPECT_EQ(scores.viewpoints, 40);
        EXPECT_EQ(scores.blocks, 640);
        for (size_t i = 0; i < 3; ++i)
            EXPECT_NEAR(100 * scores.criticalErrors[i], percent[i], 0.005) << file;
    }
}

TEST(Scores, AveragesOverViewpoints) {
    // The first has blocks 500 early and 100 late, the second one that is right.
    const std::vector<ViewpointOutcome> viewpoints = {
        {.name = "a", .blocks = {{2000, {.stop = 1500}}, {300, {.stop = 400, .open = true}}}},
        {.name = "b", .blocks = {{1000, {.stop = 800}}}},
        {.name = "nothing"}};
    const Scores scores = Score(viewpoints, {.grid = 20, .margins = {0}});
    EXPECT_EQ(scores.viewpoints, 2);
    EXPECT_EQ(scores.blocks, 3);
    EXPECT_EQ(scores.open, 1);
    EXPECT_DOUBLE_EQ(scores.absoluteError, (300 + 200) / 2.0);
    EXPECT_DOUBLE_EQ(scores.early, 0.25);  // 800 is not below 80 % of 1000
    EXPECT_DOUBLE_EQ(scores.late, 0.25);
    ASSERT_EQ(scores.criticalErrors.size(), 1u);
    // Wrong are 1520 to 1980, 320 to 380, and 820 to 980.
    EXPECT_DOUBLE_EQ(scores.criticalErrors[0], ((24 + 4) / 1000.0 + 9 / 500.0) / 2);
    EXPECT_FALSE(scores.auc || scores.accuracy);

    const Scores none = Score({}, {});
    EXPECT_EQ(none.viewpoints, 0);
    EXPECT_EQ(none.absoluteError, 0);
    EXPECT_EQ(none.criticalErrors, (std::vector<double>{0, 0, 0}));
}

TEST(Scores, BalancesTheClasses) {
    // People see noise below 100 spp. Of the two spp below, one is called noisy; of the three from
    // there on, one. Three and a half of the six pairs of scores are in the right order.
    const std::vector<BlockVerdict> verdicts = {
        {20, 0.9, true}, {60, 0.4, false}, {100, 0.4, false}, {140, 0.7, true}, {180, 0.6, false}};
    const ViewpointOutcome viewpoint{
        .name = "a", .blocks = {{.human = 100, .outcome = {.stop = 60, .verdicts = verdicts}}}};
    const Scores scores = Score({&viewpoint, 1}, {});
    ASSERT_TRUE(scores.accuracy && scores.auc);
    EXPECT_DOUBLE_EQ(*scores.accuracy, (1 / 2.0 + 2 / 3.0) / 2);
    EXPECT_DOUBLE_EQ(*scores.auc, 3.5 / 6);
}

TEST(Scores, TakesAStopForADecision) {
    const RuleOutcome outcome = OutcomeOfStop(60, 40);
    EXPECT_EQ(outcome.stop, 60);
    EXPECT_FALSE(outcome.open);
    ASSERT_EQ(outcome.verdicts.size(), 250u);
    EXPECT_EQ(outcome.verdicts[0].spp, 20);
    EXPECT_TRUE(outcome.verdicts[0].noisy);
    EXPECT_EQ(outcome.verdicts[0].score, 3);
    EXPECT_FALSE(outcome.verdicts[1].noisy);
    EXPECT_EQ(outcome.verdicts.back().spp, 9980);

    const ViewpointOutcome right{.name = "a", .blocks = {{60, outcome}}};
    EXPECT_EQ(Score({&right, 1}, {}).accuracy, 1);
    EXPECT_EQ(Score({&right, 1}, {}).auc, 1);
}

}  // namespace
}  // namespace lull
