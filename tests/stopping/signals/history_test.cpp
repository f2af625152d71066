#include "stopping/signals/history.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "stopping/signals/svd_entropy.h"
#include "tests/stopping/cut_states.h"

namespace lull {
namespace {

TEST(History, KeepsAFewStatesAnOctave) {
    History<float> history;
    size_t most = 0;
    for (int spp = 20; spp <= 100000; spp += 40) {
        history.Add({spp, {}});
        history.Thin(4);
        const auto& states = history.States();
        most = std::max(most, states.size());
        EXPECT_EQ(states.back().spp, spp);
        for (size_t i = 0; i + 2 < states.size(); ++i)
            EXPECT_TRUE(History<float>::IsStep(states[i].spp, states[i + 1].spp));
        if (spp < 200) continue;
        // Half and a quarter are there, to 5 % late and to half of 40 spp early.
        for (const double part : {2.0, 4.0}) {
            const BlockState<float>* found = history.Nearest(spp / part, 1.6);
            ASSERT_TRUE(found) << spp;
            EXPECT_NEAR(found->spp, spp / part, 21 + 0.05 * spp / part) << spp;
        }
    }
    EXPECT_LE(most, 19u);
}

TEST(History, FindsNothingFarAway) {
    History<float> history;
    history.Add({20, {}});
    EXPECT_FALSE(history.Nearest(20, 1.6));  // only what comes before the last
    EXPECT_EQ(history.At(20), &history.States()[0]);
    EXPECT_FALSE(history.At(40));
    history.Add({60, {}});
    EXPECT_EQ(history.Nearest(20, 1.6), &history.States()[0]);
    EXPECT_FALSE(history.Nearest(50, 1.6));
}

TEST(History, ForgetsWhatItIsToldTo) {
    History<float> history;
    for (const int spp : {20, 40, 60}) history.Add({spp, {}});
    history.ForgetBelow(40);
    ASSERT_EQ(history.States().size(), 2u);
    EXPECT_EQ(history.States()[0].spp, 40);
}

// Entropies of two sub-blocks to which noise adds 1 / n.
std::vector<double> EntropiesAt(int spp) { return {0.2 + 1.0 / spp, 0.4 + 4.0 / spp}; }

TEST(LatestDrop, ComparesWithHalfOfTheSamples) {
    History<float> history;
    const std::vector<double> weights = {1, 1};
    EXPECT_FALSE(LatestDrop(history, weights));
    AddEntropies(20, EntropiesAt(20), &history);
    EXPECT_FALSE(LatestDrop(history, weights));
    for (int spp = 60; spp <= 10000; spp += 40) {
        AddEntropies(spp, EntropiesAt(spp), &history);
        const auto drop = LatestDrop(history, weights);
        ASSERT_TRUE(drop) << spp;
        EXPECT_NEAR((*drop)[0] * std::sqrt(spp), 1, 0.02) << spp;
        EXPECT_NEAR((*drop)[1] * std::sqrt(spp), 2, 0.04) << spp;
    }
    EXPECT_LE(history.States().size(), 19u);
}

TEST(History, RefusesWhatDoesNotFit) {
    History<float> history;
    AddEntropies(60, EntropiesAt(60), &history);
    EXPECT_THROW(AddEntropies(60, EntropiesAt(60), &history), std::invalid_argument);
    EXPECT_THROW(AddEntropies(100, std::vector<double>{1}, &history), std::invalid_argument);
    const std::vector<double> broken = {0.1, std::numeric_limits<double>::quiet_NaN()};
    EXPECT_THROW(AddEntropies(100, broken, &history), std::invalid_argument);
    EXPECT_THROW(LatestDrop(history, std::vector<double>{1}), std::invalid_argument);
    EXPECT_THROW(History<float>().Add({0, {}}), std::invalid_argument);
}

TEST(History, GoesOnAfterARestart) {
    History<float> first, second;
    const std::vector<double> weights = {1, 1};
    for (int spp = 20; spp <= 820; spp += 40) AddEntropies(spp, EntropiesAt(spp), &first);
    StateWriter writer;
    first.Save(&writer);
    StateReader reader(writer.bytes);
    second.Restore(&reader, 2);
    reader.Finish();
    for (int spp = 860; spp <= 2000; spp += 40) {
        for (History<float>* history : {&first, &second})
            AddEntropies(spp, EntropiesAt(spp), history);
        EXPECT_EQ(*LatestDrop(second, weights), *LatestDrop(first, weights));
    }

    const auto restore = [](std::span<const std::byte> state) {
        StateReader damaged(state);
        History<float>().Restore(&damaged, 2);
    };
    ExpectRefusesCut(writer.bytes, 5, restore);
    writer.bytes[4] = writer.bytes[5] = std::byte(0xff);  // an spp beyond the next one
    EXPECT_THROW(restore(writer.bytes), std::runtime_error);
}

}  // namespace
}  // namespace lull
