#include "renderer/measure/shortfall.h"

#include <gtest/gtest.h>

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
    EXPECT_EQ(neededSpp("fixed:500", {.judged = true, .value = 100, .threshold = 500}), 500);
    EXPECT_EQ(neededSpp("lnoise:0.25",
                        {.judged = true, .value = 1, .threshold = 0.25, .visibleNoise = 1.0}),
              1600);
    EXPECT_EQ(neededSpp("fixed:99999", {.judged = true, .value = 100, .threshold = 99999}), 10000);
    // 0.65, the default of lnoise, where nothing else is known.
    EXPECT_EQ(neededSpp("learned", {.judged = true, .value = 0.9, .threshold = 0.5}), 240);
}

TEST(Shortfall, IsEmptyWhereAllHaveStopped) {
    RenderResult result;
    result.blocks = {MakeBlock(100, 1, true, 10)};
    EXPECT_TRUE(FindShortfall(WithRule("learned"), result).empty());
    EXPECT_EQ(NeededSeconds({}, result), 0);
}

}  // namespace
}  // namespace lull
