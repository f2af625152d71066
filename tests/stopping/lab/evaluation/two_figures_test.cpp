#include "stopping/lab/evaluation/two_figures.h"

#include <gtest/gtest.h>

#include "tests/stopping/lab/recordings/channel_recordings.h"

namespace lull::two_figures_test {
namespace {

EvaluatedRule Stopping(std::vector<RuleOutcome> outcomes) {
    EvaluatedRule rule{.name = "rule", .viewpoints = {{.name = "attic"}}};
    for (RuleOutcome& outcome : outcomes)
        rule.viewpoints[0].blocks.push_back({.human = 300, .outcome = std::move(outcome)});
    return rule;
}

TEST(TwoFigures, AreGivenWhereARecordingEndsTooEarly) {
    const BlockRecording part = EmptyRecording(500), whole = EmptyRecording(kMostShownSpp);
    const std::vector<LabelledBlock> blocks = {{.viewpoint = "attic",
                                                .block = 0,
                                                .human = 300,
                                                .cap = 500,
                                                .passSpp = 20,
                                                .recording = &part},
                                               {.viewpoint = "attic",
                                                .block = 1,
                                                .human = 300,
                                                .cap = 500,
                                                .passSpp = 20,
                                                .recording = &part},
                                               {.viewpoint = "attic",
                                                .block = 2,
                                                .human = 300,
                                                .cap = 10000,
                                                .passSpp = 20,
                                                .recording = &whole}};
    std::vector<EvaluatedRule> rules;
    AddTwoFigures(
        blocks, Stopping({{.stop = 500, .open = true}, {.stop = 400}, {.stop = 9000}}),
        [] {
            return Stopping({{.stop = 800}, {.stop = 400}, {.stop = 9000}});
        },
        &rules);
    ASSERT_EQ(rules.size(), 2u);
    EXPECT_EQ(LabelOf(rules[0]), "rule, at least");
    EXPECT_EQ(LabelOf(rules[1]), "rule, extended");
    for (const EvaluatedRule& rule : rules) EXPECT_EQ(Score(rule.viewpoints, {}).open, 1);
    EXPECT_EQ(rules[0].viewpoints[0].blocks[0].outcome.stop, 500);
    EXPECT_EQ(rules[1].viewpoints[0].blocks[0].outcome.stop, 800);
    EXPECT_TRUE(rules[1].viewpoints[0].blocks[0].outcome.open);
}

TEST(TwoFigures, AreOneWhereAllBlocksStop) {
    const BlockRecording part = EmptyRecording(500);
    const std::vector<LabelledBlock> blocks = {{.viewpoint = "attic",
                                                .block = 0,
                                                .human = 300,
                                                .cap = 500,
                                                .passSpp = 20,
                                                .recording = &part}};
    std::vector<EvaluatedRule> rules;
    AddTwoFigures(blocks, Stopping({{.stop = 500}}), {}, &rules);
    ASSERT_EQ(rules.size(), 1u);
    EXPECT_EQ(LabelOf(rules[0]), "rule");
}

}  // namespace
}  // namespace lull::two_figures_test
