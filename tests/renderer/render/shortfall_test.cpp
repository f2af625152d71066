#include "renderer/render/shortfall.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lull {
namespace {

BlockResult MakeBlock(int spp, double noise, bool stopped, double seconds) {
    BlockResult result;
    result.block.spp = spp;
    result.block.noise = noise;
    result.block.stopped = result.block.stoppedByVote = stopped;
    result.seconds = seconds;
    return result;
}

Provenance WithRule(const std::string& rule) {
    Provenance provenance;
    provenance.criterion = rule;
    provenance.schedule = {.passLength = 20, .cap = 10000};
    return provenance;
}

TEST(Shortfall, TakesNoiseToFallWithTheRootOfTheSamples) {
    RenderResult result;
    result.blocks = {MakeBlock(100, 1, false, 10), MakeBlock(400, 0.5, true, 40),
                     MakeBlock(200, 2, false, 30), MakeBlock(100, 0.4, false, 20)};
    result.progress.seconds = 50;  // two threads
    const std::vector<NoisyBlock> noisy = FindShortfall(WithRule("learned"), result);
    ASSERT_EQ(noisy.size(), 3u);
    EXPECT_EQ(noisy[0].block, 2);
    EXPECT_EQ(noisy[0].noise, 2);
    EXPECT_EQ(noisy[0].neededSpp, 200 * 16);  // to 0.5, which the stopped block has
    EXPECT_NEAR(noisy[0].neededSeconds, 30 * 15, 1e-9);
    EXPECT_EQ(noisy[1].block, 0);
    EXPECT_EQ(noisy[1].neededSpp, 400);
    EXPECT_EQ(noisy[2].neededSpp, 120);  // at least a pass
    EXPECT_NEAR(NeededSeconds(noisy, result), (30 * 15 + 10 * 3 + 20 * 0.2) / 2, 1e-9);
}

TEST(Shortfall, KnowsWhereSimpleRulesStop) {
    RenderResult result;
    result.blocks = {MakeBlock(100, 1, false, 10)};
    const auto neededSpp = [&](const std::string& rule, const Decision& decision) {
        result.blocks[0].decisions = {{100, decision}};
        return FindShortfall(WithRule(rule), result).at(0).neededSpp;
    };
    EXPECT_EQ(neededSpp("fixed:500", {.checked = true, .value = 100, .threshold = 500}), 500);
    EXPECT_EQ(neededSpp("lnoise:0.25", {.checked = true, .value = 1, .threshold = 0.25}), 1600);
    EXPECT_EQ(neededSpp("fixed:99999", {.checked = true, .value = 100, .threshold = 99999}), 10000);
    // 0.65, the default of lnoise, where nothing else is known.
    EXPECT_EQ(neededSpp("learned", {.checked = true, .value = 0.9, .threshold = 0.5}), 240);
}

// A block whose error falls with the root of the samples, to the cap of 1,000, beside one that has
// stopped and one of which the rule has said nothing.
RenderResult CappedResult(double errorAtCap) {
    RenderResult result;
    result.blocks = {MakeBlock(1000, 0, true, 1), MakeBlock(400, 0, true, 1),
                     MakeBlock(1000, 0, true, 1)};
    for (const int i : {0, 2}) result.blocks[size_t(i)].block.stoppedByVote = false;
    for (int spp = 20; spp <= 1000; spp += 20)
        for (const int i : {0, 1}) {
            const double error = errorAtCap * std::sqrt(1000.0 / spp) * (i == 1 ? 0.5 : 1);
            if (spp <= result.blocks[size_t(i)].block.spp)
                result.blocks[size_t(i)].decisions.push_back(
                    {spp, {.checked = true, .value = error, .threshold = 0.5}});
        }
    return result;
}

TEST(Capped, TellsWhichCapWouldDo) {
    const std::vector<CappedBlock> capped = FindCapped(CappedResult(1));
    ASSERT_EQ(capped.size(), 1u);
    EXPECT_EQ(capped[0].block, 0);
    EXPECT_DOUBLE_EQ(capped[0].value, 1);
    EXPECT_EQ(capped[0].threshold, 0.5);
    EXPECT_NEAR(capped[0].neededSpp, 4000, 400);
    const int cap = CapFor(capped, 1000);
    EXPECT_GE(cap, capped[0].neededSpp);
    EXPECT_LT(cap, 1.1 * capped[0].neededSpp);
    EXPECT_EQ(cap % 100, 0);
    // At the line, where it needs but another look.
    EXPECT_GT(FindCapped(CappedResult(0.5)).at(0).neededSpp, 1000);
}

TEST(Capped, SaysNothingWhereNothingIsKnown) {
    RenderResult counted = CappedResult(1);
    counted.trend.kind = RuleTrend::Samples;
    EXPECT_TRUE(FindCapped(counted).empty());
    RenderResult sure = CappedResult(1);
    for (BlockResult& block : sure.blocks)
        for (BlockDecision& record : block.decisions) record.decision.value = 1 - 1e-9;
    sure.blocks[1].block.stopped = sure.blocks[1].block.stoppedByVote = false;
    sure.trend.kind = RuleTrend::Probability;
    const std::vector<CappedBlock> capped = FindCapped(sure);
    ASSERT_EQ(capped.size(), 1u);
    EXPECT_EQ(capped[0].neededSpp, 0);
    EXPECT_EQ(CapFor(capped, 1000), 0);
    EXPECT_EQ(CapFor({}, 1000), 1100);
}

TEST(Shortfall, IsEmptyWhereAllHaveStopped) {
    RenderResult result;
    result.blocks = {MakeBlock(100, 1, true, 10)};
    EXPECT_TRUE(FindShortfall(WithRule("learned"), result).empty());
    EXPECT_EQ(NeededSeconds({}, result), 0);
}

}  // namespace
}  // namespace lull
