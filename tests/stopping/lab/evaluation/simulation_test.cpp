#include "stopping/lab/evaluation/simulation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "stopping/network/model_file.h"
#include "stopping/rules/rule_table.h"
#include "tests/stopping/lab/recordings/made_up_recordings.h"
#include "tests/stopping/network/random_network.h"
#include "tests/stopping/scratch_file.h"
#include "tests/stopping/signals/block_images.h"

namespace lull {
namespace {

LabelledBlock MakeBlock(const BlockRecording& recording, int human = 500) {
    return {
        .viewpoint = "kitchen", .block = 1, .human = human, .passSpp = 20, .recording = &recording};
}

// A noisy block up to `last` spp, and its recording.
struct RecordedBlock {
    BlockRecording recording;
    std::vector<BlockImage> images;

    explicit RecordedBlock(int last) {
        BlockRecorder recorder(20, last, last, &recording);
        for (int spp = 20; spp <= last; spp += 20) {
            images.push_back(NoisyBlock(40, 40, 0.15, spp, unsigned(spp)));
            recorder.Observe(images.back().At(spp));
        }
    }
    // Returns where a criterion stops, 0 for nowhere.
    int StopOf(Criterion& criterion) const {
        for (size_t i = 0; i < images.size(); ++i)
            if (criterion.Observe(images[i].At(20 * int(i + 1))).stop) return 20 * int(i + 1);
        return 0;
    }
};

TEST(Simulation, StopsWhereTheCriterionDoes) {
    // Below 400 spp every pass is recorded, so that nothing can differ. The model takes a block for
    // noiseless when the mean of its inputs is low.
    const ScratchFile model(".h5"), thresholds(".csv", "kitchen;100;150;\n");
    Network network = RandomNetwork(25, {4}, 1, 7);
    network.dense[0].kernel.setConstant(3);
    network.dense[0].bias[0] = -6.2f;
    WriteModel(model.path, network, {.k = 3, .n = 40, .m = 25, .snorm = false, .votes = 2});
    const RecordedBlock block(400);
    for (const std::string& rule :
         {std::string("dammertz:0.03"), std::string("dammertz"), std::string("luxtile:0.12"),
          std::string("cycles:0.04"), std::string("lnoise:1"), std::string("lnoise:0.9"),
          std::string("fixed:150"), "thresholds:" + thresholds.path, "learned:" + model.path}) {
        const int expected =
            block.StopOf(*MakeCriterion(ParseRule(rule, {.sceneName = "kitchen"}), {.index = 1}));
        const RuleOutcome outcome = MakeSimulator(rule)(MakeBlock(block.recording));
        EXPECT_GT(expected, 20) << rule;
        EXPECT_EQ(outcome.stop, expected) << rule;
        EXPECT_FALSE(outcome.open) << rule;
        EXPECT_EQ(outcome.verdicts.size(), 10u) << rule;
    }
}

TEST(Simulation, StopsWhereLooksAtFallsOfEntropiesDo) {
    // They check every 40 spp, as recordings beyond 400 spp do.
    const ScratchFile model(".h5");
    Network network = RandomNetwork(1, {4}, 1, 7);
    network.lstm[0].kernel.setConstant(1);
    network.dense[0].kernel.setConstant(20);
    network.dense[0].bias[0] = -20;
    WriteModel(model.path, network,
               {.k = 2,
                .n = 40,
                .features = {Feature::VisibleDrop},
                .takesMean = true,
                .voteSpacing = 40,
                .spacing = Spacing::Geometric,
                .ratio = 1.5});
    const RecordedBlock block(2400);
    for (const std::string& rule : {std::string("entropy:0.9"), "learned:" + model.path})
        for (const double caution : {1.0, 1.1}) {
            const int expected =
                block.StopOf(*MakeCriterion(ParseRule(rule, {.caution = caution})));
            const RuleOutcome outcome =
                MakeSimulator(rule, {.caution = caution})(MakeBlock(block.recording));
            EXPECT_GT(expected, 400) << rule;
            EXPECT_EQ(outcome.stop, expected) << rule << " " << caution;
        }
}

TEST(Simulation, VotesOnRecordedPasses) {
    // The noise is below 0.5 at 380 and 400 spp, then at 420, 460 and 500 with one exception.
    BlockRecording recording = EmptyRecording(600);
    SetChannel(&recording, "masked_noise",
               [](int spp) { return spp < 380 || spp == 420 ? 0.6 : 0.4; });
    const LabelledBlock block = MakeBlock(recording, 460);
    const ErrorSeries series = MakeErrorSeries(block, ParseRule("lnoise:0.5"));
    EXPECT_EQ(series.needed, 3);
    EXPECT_EQ(FirstBelow(series, 0.7), 2);
    EXPECT_EQ(FirstBelow(series, 0.3), -1);
    const RuleOutcome outcome = SimulateErrorRule(block, series, 0.5);
    EXPECT_EQ(outcome.stop, 540);
    EXPECT_FALSE(outcome.open);

    // Verdicts come at 20, 60, ..., 580, and not at 600, the end of the recording.
    ASSERT_EQ(outcome.verdicts.size(), 15u);
    for (const BlockVerdict& v : outcome.verdicts) {
        EXPECT_EQ((v.spp - 20) % 40, 0);
        EXPECT_EQ(v.noisy, v.spp < 380 || v.spp == 420) << v.spp;
        EXPECT_NEAR(v.score, v.noisy ? 0.6 : 0.4, 1e-6);
    }
    EXPECT_TRUE(SimulateErrorRule(block, series, 0.5, true).verdicts.empty());
}

TEST(Simulation, SaysWhereARecordingEndsTooEarly) {
    BlockRecording recording = EmptyRecording(700);
    SetChannel(&recording, "dammertz", [](int) { return 0.1; });
    const LabelledBlock block = MakeBlock(recording);
    const ErrorSeries series = MakeErrorSeries(block, ParseRule("dammertz:0.05"));
    for (const RuleOutcome& outcome :
         {SimulateRule(block, ParseRule("dammertz:0.05")), SimulateErrorRule(block, series, 0.05),
          SimulateCycles(block, 0.02)}) {
        EXPECT_EQ(outcome.stop, 700);
        EXPECT_TRUE(outcome.open);
        EXPECT_TRUE(outcome.verdicts.back().noisy);
    }
    // Stops known beforehand need no recording.
    EXPECT_EQ(SimulateStop(block, 5000).stop, 5000);
    EXPECT_FALSE(SimulateStop(block, 5000).open);
    EXPECT_EQ(SimulateStop(block, 123456).stop, 10000);

    BlockRecording whole = EmptyRecording(10000);
    SetChannel(&whole, "dammertz", [](int) { return 0.1; });
    const RuleOutcome never = SimulateRule(MakeBlock(whole), ParseRule("dammertz:0.05"));
    EXPECT_EQ(never.stop, 10000);
    EXPECT_FALSE(never.open);
}

TEST(Simulation, LimitsPeakNoise) {
    // 1.3 is the limit of lnoise, whose own number is 0 here.
    BlockRecording recording = EmptyRecording(400);
    SetChannel(&recording, "peak_noise", [](int spp) { return 100.0 / spp; });
    const Rule rule = ParseRule("lnoise");
    EXPECT_EQ(SimulateRule(MakeBlock(recording), rule).stop, 120);
    // Without them, as if noise were bell-shaped.
    recording.absent.set(ChannelIndex("peak_noise"));
    SetChannel(&recording, "noise", [](int) { return 2; });
    SetChannel(&recording, "masked_noise", [](int) { return 1e-3; });
    SetChannel(&recording, "half_noise",
               [](int spp) { return 2e3 * 100.0 / spp / std::pow(3, 0.25); });
    Rule unlimited = rule;
    unlimited.peak = {};
    EXPECT_EQ(SimulateRule(MakeBlock(recording), unlimited).stop, 60);
    EXPECT_EQ(SimulateRule(MakeBlock(recording), rule).stop, 120);
    // Sweeps of thresholds have the numbers by themselves.
    EXPECT_EQ(MakeErrorSeries(MakeBlock(recording), rule).errors[0],
              MakeErrorSeries(MakeBlock(recording), unlimited).errors[0]);
}

TEST(Simulation, LooksWhenTheRuleDoes) {
    // luxtile does not look at 20 spp, where the error of the made-up block is 0.
    const BlockRecording recording = EmptyRecording(200);
    const RuleOutcome outcome = MakeSimulator("luxtile:0.1")(MakeBlock(recording));
    EXPECT_EQ(outcome.stop, 40);
    EXPECT_TRUE(outcome.verdicts[0].noisy);
    EXPECT_FALSE(outcome.verdicts[1].noisy);
    EXPECT_EQ(MakeSimulator("dammertz:0.1")(MakeBlock(recording)).stop, 20);
}

TEST(Simulation, TakesTheRecordedStopsOfCycles) {
    BlockRecording recording = EmptyRecording(500);
    recording.cyclesStops[4] = 340;  // at 0.06
    const LabelledBlock block = MakeBlock(recording);
    const RuleOutcome outcome = MakeSimulator("cycles:0.06")(block);
    EXPECT_EQ(outcome.stop, 340);
    for (const BlockVerdict& v : outcome.verdicts) {
        EXPECT_EQ(v.noisy, v.spp < 340);
        EXPECT_DOUBLE_EQ(v.score, 340.0 / v.spp);
    }
    EXPECT_TRUE(MakeSimulator("cycles:0.04")(block).open);
    EXPECT_HAS(WhatOf<std::invalid_argument>([&] { SimulateCycles(block, 0.05); }),
               "0.08 0.06 0.04");
}

TEST(Simulation, RefusesWhatCannotBeSimulated) {
    const BlockRecording recording = EmptyRecording(500), empty;
    const LabelledBlock block = MakeBlock(recording);
    for (const char* rule :
         {"", "oracle:1", "luxtile", "dammertz:0.1:area", "fixed:x", "cycles:-1", "thresholds:"})
        EXPECT_THROW(MakeSimulator(rule), std::invalid_argument) << rule;
    EXPECT_THROW(MakeSimulator("thresholds:/no/such/file.csv"), std::runtime_error);
    EXPECT_HAS(WhatOf<std::invalid_argument>([] { MakeSimulator("denoised:0.5"); }), "denoised");
    EXPECT_THROW(MakeSimulator("learned:/no/such/model.h5"), std::runtime_error);
    EXPECT_THROW(MakeSimulator("learned"), std::runtime_error);
    EXPECT_THROW(MakeSimulator("fixed:20")(MakeBlock(empty)), std::invalid_argument);

    const ScratchFile file(".csv", "crown;100;150;\nkitchen;100;\n");
    const Simulator thresholds = MakeSimulator("thresholds:" + file.path);
    EXPECT_THROW(thresholds(block), std::runtime_error);  // the row has no block 1
    LabelledBlock other = block;
    other.viewpoint = "dragon";
    EXPECT_THROW(thresholds(other), std::runtime_error);

    // Beyond 400 spp, only every second pass is there.
    const ScratchFile model(".h5");
    WriteModel(model.path, RandomNetwork(25, {4}, 1), {.k = 3, .n = 20, .m = 25});
    EXPECT_THROW(MakeSimulator("learned:" + model.path)(block), std::runtime_error);
}

TEST(Simulation, GroupsBlocksByViewpoint) {
    const BlockRecording recording = EmptyRecording(500);
    std::vector<LabelledBlock> blocks(3, MakeBlock(recording));
    blocks[0].viewpoint = "crown";
    blocks[2].human = 700;
    const auto viewpoints = Simulate(blocks, MakeSimulator("fixed:90"));
    ASSERT_EQ(viewpoints.size(), 2u);
    EXPECT_EQ(viewpoints[0].name, "crown");
    EXPECT_EQ(viewpoints[0].blocks.size(), 1u);
    ASSERT_EQ(viewpoints[1].blocks.size(), 2u);
    EXPECT_EQ(viewpoints[1].blocks[1].human, 700);
    EXPECT_EQ(viewpoints[1].blocks[1].outcome.stop, 100);
}

EvaluatedRule Stopping(std::vector<RuleOutcome> outcomes) {
    EvaluatedRule rule{.name = "rule", .viewpoints = {{.name = "attic"}}};
    for (RuleOutcome& outcome : outcomes)
        rule.viewpoints[0].blocks.push_back({.human = 300, .outcome = std::move(outcome)});
    return rule;
}

TEST(TwoFigures, AreGivenWhereARecordingEndsTooEarly) {
    const BlockRecording part = EmptyRecording(500), whole = EmptyRecording(kMostShownSpp);
    const std::vector<LabelledBlock> blocks = {MakeBlock(part), MakeBlock(part), MakeBlock(whole)};
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
    const std::vector<LabelledBlock> blocks = {MakeBlock(part)};
    std::vector<EvaluatedRule> rules;
    AddTwoFigures(blocks, Stopping({{.stop = 500}}), {}, &rules);
    ASSERT_EQ(rules.size(), 1u);
    EXPECT_EQ(LabelOf(rules[0]), "rule");
}

}  // namespace
}  // namespace lull
