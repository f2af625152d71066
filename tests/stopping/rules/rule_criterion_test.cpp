#include "stopping/rules/rule.h"

#include <gtest/gtest.h>

#include <limits>
#include <memory>
#include <stdexcept>
#include <vector>

#include "stopping/rules/rule_table.h"

namespace lull {
namespace {

constexpr uint32_t kTag = 0x31303030;

// Returns a rule whose number is the program's measurement: 100 / spp, and more for others.
Rule OwnRule(const Checks& checks, int votes) {
    RuleContext context;
    context.measures["own"] = [](const BlockView& view, const BlockInfo& block) {
        return 100.0 * (block.index + 1) / view.spp;
    };
    return {.tag = kTag,
            .checks = checks,
            .threshold = 0.5,
            .votes = votes,
            .need = ViewNeed::Nothing,
            .measure = SuppliedMeasure(context, "own")};
}

std::vector<int> ChecksOf(Criterion* criterion) {
    std::vector<int> checks;
    for (int spp = 20; spp <= 2000; spp += 20) {
        const Decision decision = criterion->Observe({.width = 40, .height = 40, .spp = spp});
        if (decision.checked) checks.push_back(spp);
        if (decision.stop) break;
    }
    return checks;
}

TEST(RuleCriterion, TakesWhatTheProgramMeasures) {
    const auto first = MakeCriterion(OwnRule({}, 0), {.index = 0}),
               third = MakeCriterion(OwnRule({}, 0), {.index = 2});
    EXPECT_EQ(ChecksOf(first.get()).back(), 220);
    EXPECT_EQ(ChecksOf(third.get()).back(), 620);
    EXPECT_THROW(SuppliedMeasure({}, "own"), std::invalid_argument);
}

TEST(RuleCriterion, StopsBelowTheThresholdSoManyTimesInARow) {
    RuleCriterion criterion(std::make_shared<const Rule>(OwnRule({}, 3)), {});
    const double numbers[] = {0.1, 0.4999, 0.5, 0.0, 0.2, 0.3};  // 0.5 is not below 0.5
    const int votes[] = {1, 2, 0, 1, 2, 3};
    for (int i = 0; i < 6; ++i) {
        const Decision decision = criterion.Decide(20 * (i + 1), numbers[i]);
        EXPECT_EQ(decision.votes, votes[i]);
        EXPECT_EQ(decision.stop, i == 5);
    }
    const Decision nonsense = criterion.Decide(140, std::numeric_limits<double>::quiet_NaN());
    EXPECT_FALSE(nonsense.stop);
    EXPECT_EQ(nonsense.votes, 0);
}

TEST(RuleCriterion, DoesNotStopAtTheLimitOfPeakNoise) {
    Rule rule = OwnRule({}, 2);
    rule.peak = {.most = 2, .visibility = {.reference = 1000, .nearness = 0.5}};
    EXPECT_EQ(ParseRule("entropy:1").need, ViewNeed::MeanAndHalf);
    EXPECT_NEAR(PeakOverLimit(rule, 4, 750), 1, 1e-12);
    EXPECT_EQ(PeakOverLimit(rule, 4, 1000), 0);
    EXPECT_EQ(RaisedByPeak(rule, 0.1, 0.999), 0.1);
    EXPECT_EQ(RaisedByPeak(rule, 0.1, 1), rule.threshold);
    EXPECT_EQ(RaisedByPeak(rule, 0.1, 3), 3 * rule.threshold);
    EXPECT_EQ(RaisedByPeak(rule, 7, 3), 7);
    RuleCriterion criterion(std::make_shared<const Rule>(rule), {});
    EXPECT_EQ(criterion.Decide(20, 0.1, 0.9).votes, 1);
    EXPECT_EQ(criterion.Decide(40, 0.1, 1).votes, 0);
    EXPECT_EQ(criterion.Decide(60, 0.1, 0.9).votes, 1);
    EXPECT_TRUE(criterion.Decide(80, 0.1, 0.9).stop);
    rule.trend.kind = RuleTrend::Probability;
    EXPECT_EQ(RaisedByPeak(rule, 0.1, 1), 0.5);
    EXPECT_EQ(RaisedByPeak(rule, 0.1, 3), 0.75);
    const Rule without = ParseRule("entropy:1", {.hasHalves = false});
    EXPECT_EQ(without.need, ViewNeed::Mean);
    EXPECT_EQ(without.peak.most, 2);
    EXPECT_EQ(PeakOverLimit(OwnRule({}, 2), 4, 20), 0);
}

TEST(RuleCriterion, StopsAtOnceWhereTheRuleDoesNotVote) {
    RuleCriterion criterion(std::make_shared<const Rule>(OwnRule({}, 0)), {});
    EXPECT_FALSE(criterion.Decide(20, 0.5).stop);
    const Decision decision = criterion.Decide(40, 0.4);
    EXPECT_TRUE(decision.stop);
    EXPECT_EQ(decision.votes, 0);
}

TEST(RuleCriterion, DecidesOnSignalsAloneAsOnWhatItMeasures) {
    const auto rule = std::make_shared<const Rule>(OwnRule({}, 2));
    RuleCriterion measuring(rule, {}), told(rule, {});
    for (int spp = 20; spp <= 240; spp += 20) {
        const Decision a = measuring.Observe({.width = 40, .height = 40, .spp = spp}),
                       b = told.Decide(spp, 100.0 / spp);
        EXPECT_EQ(a.value, b.value);
        EXPECT_EQ(a.votes, b.votes);
        EXPECT_EQ(a.stop, b.stop);
        EXPECT_EQ(a.stop, spp == 240);  // 220 and 240 are below
    }
    EXPECT_EQ(measuring.Save(), told.Save());
}

// Returns the checks up to `end`, where a picture comes every `step` spp.
std::vector<int> ChecksUpTo(int end, const Checks& checks, int step = 1) {
    std::vector<int> due;
    for (int spp = step; spp <= end; spp += step)
        if (checks.AreDue(spp, due.empty() ? 0 : due.back())) due.push_back(spp);
    return due;
}

TEST(Checks, AreAtEachPictureUnlessTheRuleSaysOtherwise) {
    EXPECT_EQ(ChecksUpTo(4, {}), (std::vector<int>{1, 2, 3, 4}));
    EXPECT_EQ(ChecksUpTo(5, {.first = 3}), (std::vector<int>{3, 4, 5}));
}

TEST(Checks, AreAGridFromTheFirst) {
    EXPECT_EQ(ChecksUpTo(150, {.first = 20, .every = 40}), (std::vector<int>{20, 60, 100, 140}));
    // A picture that the grid misses is not checked.
    EXPECT_EQ(ChecksUpTo(200, {.first = 20, .every = 40}, 30), (std::vector<int>{60, 180}));
}

TEST(Checks, AreFarEnoughApartWherePicturesComeAtAnySpp) {
    EXPECT_EQ(ChecksUpTo(200, {.every = 40, .any = true}, 30), (std::vector<int>{30, 90, 150}));
    EXPECT_EQ(ChecksUpTo(100, {.every = 40, .any = true}), (std::vector<int>{1, 41, 81}));
}

TEST(Checks, WaitUntilTheSamplesHaveGrown) {
    EXPECT_EQ(ChecksUpTo(1500, {.first = 40, .growth = 2}, 20),
              (std::vector<int>{40, 80, 160, 320, 640, 1280}));
    EXPECT_EQ(ChecksUpTo(60, {.first = 20, .growth = 1.25}, 10),
              (std::vector<int>{20, 30, 40, 50}));
}

TEST(Checks, AreSoonerWhereTheNumberIsNearTheThreshold) {
    const Checks checks{.first = 20, .growth = 1.25};
    // The first of the passes that is due after a check at 2000 spp.
    const auto next = [&](double over) {
        int spp = 2020;
        while (!checks.AreDue(spp, 2000, over)) spp += 20;
        return spp;
    };
    EXPECT_EQ(next(3), 2500);
    EXPECT_EQ(next(1.105), 2220);
    EXPECT_EQ(next(1), 2060);
    EXPECT_TRUE(Checks().AreDue(2001, 2000, 3));
}

TEST(RuleCriterion, ChecksWhereTheNumberFallsToTheThreshold) {
    const auto rule = std::make_shared<const Rule>(OwnRule({.first = 20, .growth = 1.25}, 1));
    // Below the threshold from 1011 spp on.
    const auto error = [](int spp) { return 0.5 * 1010 / spp; };
    auto criterion = std::make_unique<RuleCriterion>(rule, BlockInfo());
    std::vector<int> checks;
    for (int spp = 20; checks.empty() || error(checks.back()) >= 0.5; spp += 20) {
        const Decision decision = criterion->Decide(spp, error(spp));
        if (decision.checked) checks.push_back(spp);
        EXPECT_EQ(decision.stop, spp == 1020);
        auto restored = std::make_unique<RuleCriterion>(rule, BlockInfo());
        restored->Restore(criterion->Save());
        criterion = std::move(restored);
    }
    EXPECT_EQ(checks, (std::vector<int>{20, 40, 60, 80, 100, 140, 180, 240, 300, 380, 480, 600, 760,
                                        960, 1020}));
}

}  // namespace
}  // namespace lull
