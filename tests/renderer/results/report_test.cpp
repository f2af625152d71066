#include "renderer/results/report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace lull {
namespace {

// Two blocks of 100 pixels at a cap of 100: one stopped at 20 spp, one went on to the cap.
RenderResult TwoBlocks() {
    RenderResult result;
    result.blocks.resize(2);
    result.blocks[0].block = {
        .pixels = {{0, 0}, {10, 10}}, .spp = 20, .stopped = true, .stoppedByVote = true};
    result.blocks[0].seconds = 2;
    result.blocks[0].criterionSeconds = 1;
    Decision decision;
    decision.value = 0.25;
    decision.threshold = 0.5;
    decision.votes = 1;
    result.blocks[0].decisions = {{20, decision}};
    result.blocks[0].block.noise = 0.5;
    result.blocks[1].block = {
        .pixels = {{10, 0}, {20, 10}}, .spp = 100, .votes = false, .leader = 0, .stopped = true};
    result.blocks[1].seconds = 20;
    result.progress = {.blocks = 2,
                       .stoppedBlocks = 2,
                       .blocksAtCap = 1,
                       .medianSpp = 100,
                       .samples = 12000,
                       .seconds = 12};
    return result;
}

TEST(ComputeSavings, ComparesWithEveryBlockAtTheCap) {
    const Savings savings = ComputeSavings(TwoBlocks(), 100);
    EXPECT_EQ(savings.samples, 12000);
    EXPECT_EQ(savings.samplesAtCount, 20000);
    EXPECT_DOUBLE_EQ(savings.SampleShare(), 0.4);
    EXPECT_DOUBLE_EQ(savings.secondsAtCount, 2 * 5 + 20);  // the slow block's samples cost more
    EXPECT_DOUBLE_EQ(savings.seconds, 23);
    EXPECT_DOUBLE_EQ(savings.criterionSeconds, 1);
    EXPECT_DOUBLE_EQ(savings.SecondShare(), 1 - 23. / 30);
}

TEST(ComputeSavings, SavesNothingWithoutABlock) {
    EXPECT_EQ(ComputeSavings({}, 100).SampleShare(), 0);
    EXPECT_EQ(ComputeSavings({}, 100).SecondShare(), 0);
}

TEST(ReportJson, HoldsBlocksTotalsAndProvenance) {
    Provenance provenance;
    provenance.version = "1.2.3";
    provenance.scene = "a \"quoted\" name\xff";
    provenance.seed = 0xffffffffffffffffull;
    provenance.criterion = "dammertz:0.02";
    provenance.schedule.cap = 100;
    const auto report = nlohmann::json::parse(
        Dump(ReportJson(provenance, TwoBlocks(), 3, {{"zero-area triangle", 7}}, nullptr)));
    EXPECT_EQ(report["provenance"]["seed"], 0xffffffffffffffffull);
    EXPECT_EQ(report["provenance"]["sampler"], "sobol");
    EXPECT_EQ(report["provenance"]["estimator"], "combined");
    EXPECT_EQ(report["totals"]["rejectedSamples"], 3);
    EXPECT_EQ(report["totals"]["samplesSaved"], 0.4);
    EXPECT_EQ(report["totals"]["cleanBlocks"], 1);
    EXPECT_EQ(report["totals"]["blocksAtCap"], 1);
    EXPECT_EQ(report["warnings"]["zero-area triangle"], 7);
    const auto& blocks = report["blocks"];
    ASSERT_EQ(blocks.size(), 2u);
    EXPECT_EQ(blocks[0]["end"], "clean");
    EXPECT_EQ(blocks[0]["maskedNoise"], 0.5);
    EXPECT_EQ(blocks[0]["threshold"], 20);
    EXPECT_EQ(blocks[0]["decisions"]["spp"], nlohmann::json({20}));
    EXPECT_EQ(blocks[0]["decisions"]["value"], nlohmann::json({0.25}));
    EXPECT_EQ(blocks[0]["decisions"]["votes"], nlohmann::json({1}));
    EXPECT_EQ(blocks[1]["end"], "cap");
    EXPECT_EQ(blocks[1]["x"], 10);
    EXPECT_EQ(blocks[1]["follows"], 0);
    EXPECT_FALSE(blocks[1].contains("decisions"));
}

}  // namespace
}  // namespace lull
