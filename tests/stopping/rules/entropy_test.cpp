#include "stopping/rules/entropy.h"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

#include "stopping/base/block_view.h"
#include "stopping/rules/rule_table.h"
#include "tests/stopping/rules/restarts.h"
#include "tests/stopping/signals/block_images.h"

namespace lull {
namespace {

BlockImage At(int spp) { return NoisyBlock(100, 100, 0.2, spp, unsigned(spp)); }

// Runs a rule over blocks whose noise falls, after `begin` spp; returns the decisions up to a stop.
std::vector<Decision> Decide(Criterion* rule, int begin, int end) {
    std::vector<Decision> decisions;
    for (int spp = begin + 20; spp <= end; spp += 20) {
        BlockImage block = At(spp);
        BlockView view = block.At(spp);
        view.halfMean = {};  // it is not needed
        if (rule->Need(spp) == ViewNeed::Nothing) view.mean = {};
        decisions.push_back(rule->Observe(view));
        if (decisions.back().stop) break;
    }
    return decisions;
}

TEST(EntropyRule, StopsAfterThreeChecksInARow) {
    const auto rule = MakeCriterion(EntropyRule(1.5, {}, 20));
    const std::vector<Decision> decisions = Decide(rule.get(), 0, 4000);
    const int stop = 20 * int(decisions.size());
    ASSERT_TRUE(decisions.back().stop);
    EXPECT_EQ((stop - 20) % 40, 0);
    EXPECT_GT(stop, 140);
    EXPECT_LT(stop, 4000);
    EXPECT_EQ(decisions.back().votes, 3);
    EXPECT_EQ(decisions.back().threshold, 1.5);
    for (size_t i = 0; i < decisions.size(); ++i) {
        EXPECT_EQ(decisions[i].checked, i >= 2 && i % 2 == 0) << i;
        EXPECT_TRUE(i < 2 || decisions[i].value > 0);
        if (i + 1 < decisions.size()) {
            EXPECT_FALSE(decisions[i].stop);
        }
    }
    for (const size_t back : {1, 3, 5}) EXPECT_LT(decisions[decisions.size() - back].value, 1.5);
    EXPECT_GE(decisions[decisions.size() - 7].value, 1.5);
}

TEST(EntropyRule, NeedsFourTimesTheSamplesForHalfOfTheThreshold) {
    const NoiseVisibility visibility{.reference = 1 << 30};
    const auto spp = [&](double threshold) {
        return 20.0 *
               double(Decide(MakeCriterion(EntropyRule(threshold, visibility, 20)).get(), 0, 9000)
                          .size());
    };
    const double once = spp(0.8), half = spp(0.4);
    EXPECT_NEAR(half / once, 4, 0.8);
}

TEST(EntropyRule, ChecksWhereRecordingsHavePasses) {
    const Checks checks = EntropyChecks(20);
    for (const int spp : {20, 60, 100, 420, 9980}) EXPECT_TRUE(checks.AreDue(spp)) << spp;
    for (const int spp : {40, 80, 400, 10000}) EXPECT_FALSE(checks.AreDue(spp)) << spp;
    EXPECT_TRUE(EntropyChecks(1).AreDue(1));
    EXPECT_FALSE(EntropyChecks(1).AreDue(2));
    EXPECT_TRUE(EntropyChecks(1).AreDue(41));
    EXPECT_TRUE(EntropyChecks(100).AreDue(200));
}

TEST(EntropyRule, GoesOnAsIfNeverInterrupted) {
    ExpectGoesOn(EntropyRule(1.5, {}, 20), {20, 60, 120, 200}, 4000, Decide);
}

TEST(EntropyRule, RefusesOtherState) {
    const auto rule = MakeCriterion(EntropyRule(1.5, {}, 20));
    Decide(rule.get(), 0, 300);
    const std::vector<std::byte> state = rule->Save();
    ExpectRefusesOtherLengths(EntropyRule(1.5, {}, 20), state, 97);
    EXPECT_THROW(MakeCriterion(ParseRule("lnoise:1"))->Restore(state), std::runtime_error);
}

TEST(EntropyRule, IsARule) {
    const Rule factory = ParseRule("entropy:0.5");
    EXPECT_EQ(factory.text, "entropy:0.5");
    EXPECT_EQ(factory.smallestSide, kSmallestVotingSide);
    const auto rule = MakeCriterion(factory);
    EXPECT_EQ(rule->Need(20), ViewNeed::MeanAndHalf);
    EXPECT_EQ(MakeCriterion(ParseRule("entropy", {.hasHalves = false}))->Need(20), ViewNeed::Mean);
    EXPECT_EQ(rule->Need(40), ViewNeed::Nothing);
    EXPECT_TRUE(ParseRule("entropy").text.starts_with("entropy:0."));
    EXPECT_THROW(ParseRule("entropy:0"), std::invalid_argument);
    EXPECT_THROW(ParseRule("entropy:"), std::invalid_argument);
    EXPECT_THROW(rule->Observe(BlockImage(9, 40, 0.5f).At(20)), std::invalid_argument);
}

TEST(EntropyRule, ComparesWithThePictureAtALargerCap) {
    const auto valueAt = [](int cap) {
        const auto rule =
            MakeCriterion(ParseRule("entropy:0.01", {.cap = cap, .hasHalves = false}));
        return Decide(rule.get(), 0, 1020).back().value;
    };
    const double standard = valueAt(0);
    EXPECT_EQ(valueAt(10000), standard);
    EXPECT_EQ(valueAt(6000), standard);
    EXPECT_NEAR(valueAt(1 << 24) / standard, 1 / std::sqrt(1 - 0.102), 1e-3);
}

TEST(EntropyRule, SurvivesAnyBlock) {
    const float infinity = std::numeric_limits<float>::infinity();
    for (const float value :
         {0.f, 1.f, 1e30f, -1.f, infinity, -infinity, std::numeric_limits<float>::quiet_NaN()}) {
        const auto rule = MakeCriterion(EntropyRule(0.6, {}, 20));
        const BlockImage block(41, 57, value);
        int stop = 0;
        for (int spp = 20; spp <= 200 && stop == 0; spp += 20) {
            const Decision decision = rule->Observe(block.At(spp));
            EXPECT_TRUE(decision.value >= 0 && std::isfinite(decision.value)) << value;
            if (decision.stop) stop = spp;
        }
        EXPECT_EQ(stop, 140) << value;
    }
}

}  // namespace
}  // namespace lull
