#include "stopping/rules/voting.h"

#include <gtest/gtest.h>

#include <stdexcept>
#include <vector>

#include "tests/stopping/signals/block_images.h"

namespace lull {
namespace {

constexpr uint32_t kTag = 0x31303030;

// Returns a rule whose number is what the program says of a block: 100 / spp, and more for others.
VotingRule OwnRule(const Looking& looking, int votes) {
    RuleContext context;
    context.measures["own"] = [](const BlockView& view, const BlockInfo& block) {
        return 100.0 * (block.index + 1) / view.spp;
    };
    return {.threshold = 0.5,
            .votes = votes,
            .tag = kTag,
            .need = ViewNeed::Nothing,
            .measure = SuppliedMeasure(context, "own"),
            .makeGauge = [=](const BlockInfo&) { return MakeMeasuredGauge(1, looking); }};
}

std::vector<int> LooksOf(Criterion* criterion, int begin, int end) {
    std::vector<int> looks;
    for (int spp = begin; spp <= end; spp += 20) {
        const Decision decision = criterion->Observe({.width = 40, .height = 40, .spp = spp});
        if (decision.judged) looks.push_back(spp);
        if (decision.stop) break;
    }
    return looks;
}

TEST(Voting, TakesWhatTheProgramMeasures) {
    const auto first = MakeVoting(OwnRule({}, 0), {.index = 0}),
               third = MakeVoting(OwnRule({}, 0), {.index = 2});
    EXPECT_EQ(LooksOf(first.get(), 20, 2000).back(), 220);
    EXPECT_EQ(LooksOf(third.get(), 20, 2000).back(), 620);
    EXPECT_THROW(SuppliedMeasure({}, "own"), std::invalid_argument);
}

TEST(Voting, LooksWhereTheSamplesHaveGrown) {
    const Looking octaves{.firstSpp = 40, .growth = 2};
    EXPECT_EQ(LooksOf(MakeVoting(OwnRule(octaves, 3)).get(), 20, 10000),
              (std::vector<int>{40, 80, 160, 320, 640, 1280}));
    // Interrupted anywhere, it looks at the same.
    for (const int split : {20, 40, 60, 160, 500}) {
        const auto before = MakeVoting(OwnRule(octaves, 3)),
                   after = MakeVoting(OwnRule(octaves, 3));
        std::vector<int> looks = LooksOf(before.get(), 20, split);
        after->Restore(before->Save());
        EXPECT_EQ(after->Save(), before->Save());
        for (const int spp : LooksOf(after.get(), split + 20, 10000)) looks.push_back(spp);
        EXPECT_EQ(looks, (std::vector<int>{40, 80, 160, 320, 640, 1280})) << split;
    }
}

TEST(Voting, DecidesOnSignalsAloneAsOnWhatItMeasures) {
    const VotingRule rule = OwnRule({}, 2);
    const auto criterion = MakeVoting(rule);
    Decider decider(rule, {});
    for (int spp = 20; spp <= 240; spp += 20) {
        const Decision a = criterion->Observe({.width = 40, .height = 40, .spp = spp}),
                       b = decider.Decide(spp, 100.0 / spp);
        EXPECT_EQ(a.value, b.value);
        EXPECT_EQ(a.votes, b.votes);
        EXPECT_EQ(a.stop, b.stop);
        EXPECT_EQ(a.stop, spp == 240);  // 220 and 240 are below
    }
    EXPECT_EQ(criterion->Save(), decider.Save());
}

TEST(Voting, RefusesStatesThatAreNotItsOwn) {
    const auto rule = MakeVoting(OwnRule({.firstSpp = 20, .growth = 2}, 3));
    std::vector<std::byte> state = rule->Save();
    for (size_t size = 0; size < state.size(); ++size)
        EXPECT_THROW(rule->Restore(std::span(state).first(size)), std::runtime_error) << size;
    state[0] ^= std::byte(1);
    EXPECT_THROW(rule->Restore(state), std::runtime_error);
}

}  // namespace
}  // namespace lull
