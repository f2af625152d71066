#include "stopping/lab/evaluation/constants.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace lull {
namespace {

ViewpointOutcome People(const std::string& name, const std::vector<int>& thresholds) {
    ViewpointOutcome viewpoint{.name = name};
    for (const int human : thresholds)
        viewpoint.blocks.push_back({.human = human, .block = int(viewpoint.blocks.size()) + 3});
    return viewpoint;
}

TEST(Constants, AreTheBestOfTheirKind) {
    const std::vector<ViewpointOutcome> people = {People("a", {1000, 1000, 4000}),
                                                  People("b", {3000, 3000, 3000})};
    const auto rules = EvaluateConstants(people, ChooseBy::AbsoluteError, 40);
    ASSERT_EQ(rules.size(), 3u);
    EXPECT_EQ(rules[0].name, "constant, known");
    // The median has the least mean distance.
    EXPECT_EQ(rules[0].viewpoints[0].blocks[2].outcome.stop, 1000);
    EXPECT_EQ(rules[0].viewpoints[1].blocks[0].outcome.stop, 3000);
    EXPECT_EQ(rules[1].viewpoints[0].blocks[0].outcome.stop, 3000);
    EXPECT_EQ(rules[1].viewpoints[1].blocks[0].outcome.stop, 1000);
    // Of all: from 1,000 on b gains 1 for each spp where a loses 1/3.
    EXPECT_EQ(rules[2].setting, "3000");
    EXPECT_EQ(rules[0].viewpoints[0].blocks[1].block, 4);
    EXPECT_EQ(rules[0].viewpoints[0].blocks[1].human, 1000);
    EXPECT_FALSE(rules[0].viewpoints[0].blocks[1].outcome.verdicts.empty());
}

TEST(Constants, CanBeChosenByTheCriticalError) {
    const std::vector<ViewpointOutcome> people = {People("a", {500, 9000})};
    const auto rules = EvaluateConstants(people, ChooseBy::CriticalError, 40);
    ASSERT_EQ(rules.size(), 2u);  // there are no others
    const int stop = rules[0].viewpoints[0].blocks[0].outcome.stop;
    for (const int other : {500, 2000, 9000}) {
        ViewpointOutcome there = people[0];
        for (BlockOutcome& block : there.blocks) block.outcome.stop = other;
        EXPECT_LE(CriticalError(rules[0].viewpoints[0].blocks, 2, 40),
                  CriticalError(there.blocks, 2, 40))
            << stop;
    }
}

TEST(Constants, NeedAViewpoint) {
    EXPECT_THROW(EvaluateConstants({}, ChooseBy::AbsoluteError, 40), std::invalid_argument);
}

}  // namespace
}  // namespace lull
