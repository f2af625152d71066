#include "stopping/lab/evaluation/evaluated_rules.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>

#include "stopping/network/model_file.h"
#include "stopping/rules/rule_table.h"
#include "tests/stopping/lab/training/learning_data.h"
#include "tests/stopping/network/random_network.h"

namespace lull {
namespace {

TEST(RecordedRules, HaveAnEntryForEachRule) {
    ASSERT_EQ(RecordedRules().size(), RuleTable().size());
    const RuleContext context = {
        .models = LULL_SOURCE_DIR "/stopping/models",
        .measures = {{"denoised", [](const BlockView&, const BlockInfo&) { return Signals{}; }}}};
    for (size_t i = 0; i < RuleTable().size(); ++i) {
        const RuleEntry& rule = RuleTable()[i];
        const RecordedRule& recorded = RecordedRules()[i];
        const std::string name(rule.name);
        EXPECT_EQ(recorded.name, name);
        if (name == "thresholds") continue;  // reads a file
        const bool isComplete = rule.standard || rule.argument.starts_with('[');
        const Rule read = ParseRule(isComplete ? name : name + ":1", context);
        EXPECT_EQ(recorded.replay == Replay::Counts, bool(read.stopAt)) << name;
        EXPECT_EQ(recorded.replay == Replay::Decides, HasRecordedSignals(read)) << name;
        for (const double setting : recorded.curve)
            EXPECT_NO_THROW(ParseRule(name + ":" + std::to_string(setting))) << name;
        EXPECT_TRUE(std::ranges::is_sorted(recorded.curve, std::greater<>())) << name;
        EXPECT_GE(recorded.largest, recorded.least);
    }
    EXPECT_FALSE(HasRecordedSignals(ParseRule("dammertz:0.1:area")));
    EXPECT_EQ(FindRecordedRule("oracle:1"), nullptr);
}

void Ignore(const std::string&) {}

TEST(EvaluatedRules, AreThresholdsOfTheViewpointsThatPeopleJudged) {
    const LearningData data;
    ThresholdsRow late = MakeHumanRow("attic");
    for (int& spp : late.spp) spp += 40;
    const ScratchFile predicted(".csv", Line(late) + Line(MakeHumanRow("shed")));
    const std::vector<ThresholdsRow> people = ReadHumanThresholds(data.human.path, {});
    std::vector<std::string> said;
    const EvaluatedRule rule =
        EvaluateThresholds(predicted.path, data.human.path, people, 40,
                           [&](const std::string& message) { said.push_back(message); });
    ASSERT_EQ(rule.viewpoints.size(), 1u);
    EXPECT_EQ(rule.viewpoints[0].name, "attic");
    EXPECT_EQ(Score(rule.viewpoints, {}).absoluteError, 40);
    ASSERT_EQ(said.size(), 1u);
    EXPECT_TRUE(said[0].starts_with("1 of 2 viewpoints in ")) << said[0];

    EXPECT_EQ(ReadHumanThresholds(data.human.path, {"attic"}).size(), 1u);
    EXPECT_THROW(ReadHumanThresholds(data.human.path, {"shed"}), std::runtime_error);
    const ScratchFile other(".csv", Line(MakeHumanRow("shed"))), few(".csv", "attic;40;\n");
    for (const std::string& path : {other.path, few.path})
        EXPECT_THROW(EvaluateThresholds(path, data.human.path, people, 40, Ignore),
                     std::runtime_error);
}

TEST(EvaluatedRules, RunOnRecordings) {
    const LearningData data;
    const ScratchFile predicted(".csv", Line(MakeHumanRow("attic")) + Line(MakeHumanRow("barn")));
    const std::vector<LabelledBlock> blocks = data.Blocks();
    const std::vector<EvaluatedRule> rules = EvaluateOnBlocks(
        blocks, {.rivals = true, .rules = {"fixed:400"}, .predicted = {predicted.path}});
    ASSERT_GT(rules.size(), 3u);
    EXPECT_NE(rules.front().setting, "");  // a rival
    const EvaluatedRule& fixed = rules[rules.size() - 3];
    EXPECT_EQ(fixed.name, "fixed:400");
    EXPECT_EQ(fixed.viewpoints.at(1).blocks.at(2).outcome.stop, 400);
    EXPECT_EQ(Score(rules[rules.size() - 2].viewpoints, {}).absoluteError, 0);
    EXPECT_FALSE(rules[rules.size() - 2].name.ends_with(", clipped"));
    EXPECT_TRUE(rules.back().name.ends_with(", clipped"));

    // A threshold beyond the end of a recording is open there, if it is clipped.
    ThresholdsRow late = MakeHumanRow("attic");
    late.spp[1] = 5000;
    const ScratchFile beyond(".csv", Line(late) + Line(MakeHumanRow("barn")));
    const std::vector<EvaluatedRule> files = EvaluateOnBlocks(blocks, {.predicted = {beyond.path}});
    ASSERT_EQ(files.size(), 2u);
    EXPECT_EQ(files[0].viewpoints[0].blocks[1].outcome.stop, 5000);
    EXPECT_EQ(files[1].viewpoints[0].blocks[1].outcome.stop, 1200);
    EXPECT_TRUE(files[1].viewpoints[0].blocks[1].outcome.open);
    EXPECT_FALSE(files[1].viewpoints[0].blocks[0].outcome.open);
    // So is a block of a rule, which has a second row on extended recordings.
    const std::vector<EvaluatedRule> open = EvaluateOnBlocks(blocks, {.rules = {"lnoise:0.5"}});
    ASSERT_EQ(open.size(), 2u);
    EXPECT_EQ(open[0].openStops, OpenStops::Ends);
    EXPECT_EQ(open[1].openStops, OpenStops::Extended);
    EXPECT_EQ(open[0].viewpoints[0].blocks[0].outcome.stop, 1200);
    // Noise of 20 / sqrt(n).
    EXPECT_NEAR(open[1].viewpoints[0].blocks[0].outcome.stop, 1600, 150);
    const ScratchFile part(".csv", Line(MakeHumanRow("attic")));
    EXPECT_THROW(EvaluateOnBlocks(blocks, {.predicted = {part.path}}), std::runtime_error);
}

TEST(EvaluatedRules, TellWhichBlocksAModelHasSeen) {
    const LearningData data;
    const ScratchFile model(".h5");
    WriteModel(model.path, RandomNetwork(25, {4}, 1), {.k = 2, .m = 25, .voteSpacing = 40},
               {{"training_blocks", "attic: 0 2\nshed: 1"}});
    const EvaluatedRule rule =
        EvaluateOnBlocks(data.Blocks(), {.rules = {"learned:" + model.path}}).front();
    EXPECT_EQ(Score(rule.viewpoints, {}).seen, 2);
    for (const BlockOutcome& block : rule.viewpoints.at(0).blocks)
        EXPECT_EQ(block.seen, block.block == 0 || block.block == 2);
    const EvaluatedRule other = EvaluateOnBlocks(data.Blocks(), {.rules = {"fixed:400"}}).front();
    EXPECT_EQ(Score(other.viewpoints, {}).seen, 0);
}

}  // namespace
}  // namespace lull
