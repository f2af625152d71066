#include "stopping/signals/drop_history.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "stopping/signals/ladder.h"

namespace lull {
namespace {

struct Entry {
    int spp;
};

TEST(Ladder, KeepsAFewStatesAnOctave) {
    std::vector<Entry> ladder;
    size_t most = 0;
    for (int spp = 20; spp <= 100000; spp += 40) {
        AddToLadder(Entry{spp}, 4, &ladder);
        most = std::max(most, ladder.size());
        EXPECT_EQ(ladder.back().spp, spp);
        for (size_t i = 0; i + 2 < ladder.size(); ++i)
            EXPECT_TRUE(IsLadderStep(ladder[i].spp, ladder[i + 1].spp));
        if (spp < 200) continue;
        // Half and a quarter are there, to 5 % late and to half of 40 spp early.
        for (const double part : {2.0, 4.0}) {
            const Entry* found = FindInLadder(ladder, spp / part, 1.6, true);
            ASSERT_TRUE(found) << spp;
            EXPECT_NEAR(found->spp, spp / part, 21 + 0.05 * spp / part) << spp;
        }
    }
    EXPECT_LE(most, 19u);
}

TEST(Ladder, FindsNothingFarAway) {
    std::vector<Entry> ladder;
    AddToLadder(Entry{20}, 4, &ladder);
    EXPECT_FALSE(FindInLadder(ladder, 20, 1.6, true));
    EXPECT_EQ(FindInLadder(ladder, 20, 1.6, false), &ladder[0]);
    EXPECT_FALSE(FindInLadder(ladder, 50, 1.6, false));
}

// Entropies of two sub-blocks to which noise adds 1 / n.
std::vector<double> At(int spp) { return {0.2 + 1.0 / spp, 0.4 + 4.0 / spp}; }

TEST(DropHistory, ComparesWithHalfOfTheSamples) {
    DropHistory history;
    const std::vector<double> weights = {1, 1};
    EXPECT_FALSE(history.Add(20, At(20), weights));
    for (int spp = 60; spp <= 10000; spp += 40) {
        const auto drop = history.Add(spp, At(spp), weights);
        ASSERT_TRUE(drop) << spp;
        EXPECT_NEAR((*drop)[0] * std::sqrt(spp), 1, 0.02) << spp;
        EXPECT_NEAR((*drop)[1] * std::sqrt(spp), 2, 0.04) << spp;
    }
    EXPECT_LE(history.States().size(), 19u);
}

TEST(DropHistory, RefusesWhatDoesNotFit) {
    DropHistory history;
    const std::vector<double> weights = {1, 1};
    history.Add(60, At(60), weights);
    EXPECT_THROW(history.Add(60, At(60), weights), std::invalid_argument);
    EXPECT_THROW(history.Add(100, std::vector<double>{1}, std::vector<double>{1}),
                 std::invalid_argument);
    EXPECT_THROW(history.Add(100, At(100), std::vector<double>{1}), std::invalid_argument);
    const std::vector<double> broken = {0.1, std::numeric_limits<double>::quiet_NaN()};
    EXPECT_THROW(history.Add(100, broken, weights), std::invalid_argument);
}

TEST(DropHistory, GoesOnAfterARestart) {
    DropHistory first, second;
    const std::vector<double> weights = {1, 1};
    for (int spp = 20; spp <= 820; spp += 40) first.Add(spp, At(spp), weights);
    StateWriter writer;
    first.Save(&writer);
    StateReader reader(writer.bytes);
    second.Restore(&reader, 2);
    reader.Finish();
    for (int spp = 860; spp <= 2000; spp += 40)
        EXPECT_EQ(*second.Add(spp, At(spp), weights), *first.Add(spp, At(spp), weights));

    for (size_t size = 0; size < writer.bytes.size(); size += 5) {
        StateReader cut(std::span(writer.bytes).first(size));
        EXPECT_THROW(DropHistory().Restore(&cut, 2), std::runtime_error);
    }
    writer.bytes[4] = writer.bytes[5] = std::byte(0xff);  // an spp beyond the next one
    StateReader damaged(writer.bytes);
    EXPECT_THROW(DropHistory().Restore(&damaged, 2), std::runtime_error);
}

}  // namespace
}  // namespace lull
