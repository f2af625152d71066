#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "stopping/lab/evaluation/evaluated_rules.h"
#include "stopping/network/model_file.h"
#include "stopping/rules/rule_table.h"
#include "tests/stopping/lab/recordings/made_up_recordings.h"
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
        EXPECT_THROW(
            EvaluateThresholds(path, data.human.path, people, 40, [](const std::string&) {}),
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

namespace lull::rivals_test {
namespace {

// Blocks of three viewpoints whose visible noise is amplitude / sqrt(spp): observers stop seeing it
// at 0.5. The errors of other rules are unrelated to it.
struct Blocks {
    std::vector<BlockRecording> recordings;
    std::vector<LabelledBlock> blocks;

    Blocks() {
        for (int i = 0; i < 9; ++i) {
            const double amplitude = 5 + 4 * i, other = 1 + (i * 5) % 9;
            BlockRecording& recording = recordings.emplace_back(EmptyRecording(10000));
            SetChannel(&recording, "masked_noise",
                       [=](int spp) { return amplitude / std::sqrt(spp); });
            for (const char* channel : {"dammertz", "luxtile"})
                SetChannel(&recording, channel, [=](int spp) { return other / std::sqrt(spp); });
            // cycles stops at half of the threshold at its third setting, at 1.5 at the fourth.
            const int human = int(std::pow(amplitude / 0.5, 2));
            recording.cyclesStops[2] = human / 2;
            recording.cyclesStops[3] = human * 3 / 2;
        }
        for (int i = 0; i < 9; ++i)
            blocks.push_back({.viewpoint = std::string(1, char('a' + i / 3)),
                              .block = i % 3,
                              .human = int(std::pow((5 + 4 * i) / 0.5, 2)),
                              .passSpp = 20,
                              .recording = &recordings[size_t(i)]});
    }
};

const EvaluatedRule& Find(const std::vector<EvaluatedRule>& rivals, const std::string& rule) {
    return *std::ranges::find(rivals, rule, &EvaluatedRule::name);
}

TEST(Rivals, FindTheBestSetting) {
    const Blocks blocks;
    for (const ChooseBy chooseBy : {ChooseBy::AbsoluteError, ChooseBy::CriticalError}) {
        const std::vector<EvaluatedRule> rivals = EvaluateRivals(blocks.blocks, chooseBy, 40);
        ASSERT_EQ(rivals.size(), 5u);
        const EvaluatedRule& noise = Find(rivals, "lnoise");
        // Three votes take 80 spp more than people, so that the best is a little above 0.5.
        EXPECT_NEAR(std::stod(noise.setting), 0.51, 0.02);
        ASSERT_EQ(noise.viewpoints.size(), 3u);
        const Scores best = Score(noise.viewpoints, {.grid = 40, .margins = {2}});
        EXPECT_EQ(best.blocks, 9);
        EXPECT_LT(best.absoluteError, 200);
        EXPECT_LT(best.criticalErrors[0], 0.01);
        EXPECT_GT(*best.auc, 0.99);
        for (const char* rule : {"dammertz", "cycles", "luxtile"})
            EXPECT_GT(Score(Find(rivals, rule).viewpoints, {}).absoluteError, 500) << rule;
        for (const ViewpointOutcome& viewpoint : noise.viewpoints)
            EXPECT_NEAR(std::stod(viewpoint.setting), 0.51, 0.03);
    }
}

TEST(Rivals, ChooseOnOtherViewpoints) {
    // The people of one viewpoint are of another mind. That changes the choice for the others, and
    // not for theirs.
    Blocks blocks;
    const auto before = EvaluateRivals(blocks.blocks, ChooseBy::AbsoluteError, 40);
    for (size_t i = 6; i < 9; ++i) blocks.blocks[i].human = 200;
    const auto after = EvaluateRivals(blocks.blocks, ChooseBy::AbsoluteError, 40);
    for (const char* rule : {"dammertz", "luxtile", "lnoise"}) {
        const EvaluatedRule &x = Find(before, rule), &y = Find(after, rule);
        EXPECT_EQ(x.viewpoints[2].setting, y.viewpoints[2].setting) << rule;
        EXPECT_NE(x.setting, y.setting) << rule;
        EXPECT_LT(std::stod(x.setting), std::stod(y.setting)) << rule;
    }
}

TEST(Rivals, TakeTheCheaperOfEqualSettings) {
    const Blocks blocks;
    // Both settings of cycles are wrong by half; the coarser comes first.
    const EvaluatedRule cycles =
        Find(EvaluateRivals(blocks.blocks, ChooseBy::AbsoluteError, 40), "cycles");
    EXPECT_EQ(std::stod(cycles.setting), kCyclesThresholds[2]);
    EXPECT_EQ(cycles.viewpoints[0].setting, "0.16");
    EXPECT_EQ(cycles.viewpoints[0].blocks[1].outcome.stop, blocks.blocks[1].human / 2);
}

TEST(Rivals, NeedTwoViewpoints) {
    const Blocks blocks;
    EXPECT_THROW(EvaluateRivals(std::span(blocks.blocks).first(3), ChooseBy::AbsoluteError, 40),
                 std::invalid_argument);
    EXPECT_THROW(EvaluateRivals({}, ChooseBy::AbsoluteError, 40), std::invalid_argument);
}

}  // namespace
}  // namespace lull::rivals_test

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
