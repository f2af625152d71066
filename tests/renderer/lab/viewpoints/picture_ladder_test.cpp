#include "renderer/lab/viewpoints/picture_ladder.h"

#include <gtest/gtest.h>

#include <cmath>

#include "stopping/rules/baselines.h"
#include "stopping/signals/lightness.h"
#include "tests/stopping/cut_states.h"

namespace lull {
namespace {

using Levels = std::vector<int>;

TEST(LadderByRatio, GoesUpByAQuarterToTheCap) {
    const Levels levels = LadderByRatio(20, 10000, 1.25);
    EXPECT_EQ(levels.front(), 20);
    EXPECT_EQ(levels.back(), 10000);
    EXPECT_GE(levels.size(), 24u);  // about log(500) / log(1.25), less where passes are too coarse
    EXPECT_LE(levels.size(), 30u);
    for (size_t i = 0; i + 1 < levels.size(); ++i) {
        EXPECT_EQ(levels[i] % 20, 0);
        EXPECT_GT(levels[i + 1], levels[i]);
        // The last step takes in what would lie too near to the cap.
        if (levels[i] >= 400) {
            EXPECT_NEAR(double(levels[i + 1]) / levels[i], 1.25, 0.15);
        }
    }
    EXPECT_EQ(LadderByRatio(20, 70, 1.25), (Levels{20, 40, 60, 70}));
    EXPECT_EQ(LadderByRatio(20, 65, 1.25), (Levels{20, 40, 65}));  // 60 is too near
    EXPECT_EQ(LadderByRatio(20, 20, 1.25), Levels{20});
    EXPECT_EQ(LadderByRatio(1, 1 << 24, 1.25).back(), 1 << 24);
    EXPECT_THROW(LadderByRatio(20, 100, 1), std::invalid_argument);
}

TEST(LadderByCount, HasAsManyLevelsAsThereCanBe) {
    EXPECT_EQ(LadderByCount(20, 320, 5), (Levels{20, 40, 80, 160, 320}));
    EXPECT_EQ(LadderByCount(20, 80, 10), (Levels{20, 40, 60, 80}));
    EXPECT_EQ(LadderByCount(20, 10000, 28).size(), 28u);
    EXPECT_EQ(LadderByCount(20, 20, 3), Levels{20});
    EXPECT_THROW(LadderByCount(20, 100, 1), std::invalid_argument);
}

// Shows a block of 4 x 2 pixels that brightens with the samples.
struct Brightening {
    std::vector<float> mean;

    BlockView At(int spp) {
        mean.assign(24, float(spp) / 200);
        return {.width = 4, .height = 2, .spp = spp, .mean = mean};
    }
};

TEST(PictureLadder, KeepsWhatADisplayShowsAtItsLevels) {
    Brightening block;
    std::vector<DisplayPixels> pictures;
    PictureLadder ladder({40, 100}, nullptr, &pictures);
    for (int spp = 20; spp <= 100; spp += 20) {
        EXPECT_EQ(ladder.Need(spp), spp == 40 || spp == 100 ? ViewNeed::Mean : ViewNeed::Nothing);
        EXPECT_EQ(ladder.Observe(block.At(spp)).stop, spp == 100);
    }
    ASSERT_EQ(pictures.size(), 2u);
    DisplayPixels expected(24);
    EncodeSrgb8(block.At(40).mean, expected);
    EXPECT_EQ(pictures[0], expected);
    EncodeSrgb8(block.At(100).mean, expected);
    EXPECT_EQ(pictures[1], expected);
}

TEST(PictureLadder, GoesOnFromASavedStateWithItsCompanion) {
    Brightening block;
    std::vector<DisplayPixels> whole, first, second;
    PictureLadder uninterrupted({20, 60, 100}, MakeCriterion(FixedRule(1000)), &whole);
    PictureLadder before({20, 60, 100}, MakeCriterion(FixedRule(1000)), &first);
    PictureLadder after({20, 60, 100}, MakeCriterion(FixedRule(1000)), &second);
    for (const int spp : {20, 40, 60}) {
        uninterrupted.Observe(block.At(spp));
        before.Observe(block.At(spp));
    }
    after.Restore(before.Save());
    for (const int spp : {80, 100}) {
        uninterrupted.Observe(block.At(spp));
        after.Observe(block.At(spp));
    }
    EXPECT_EQ(second, whole);
    EXPECT_EQ(after.Save(), uninterrupted.Save());

    const std::vector<std::byte> state = before.Save();
    PictureLadder alone({20, 60, 100}, nullptr, &first);
    EXPECT_THROW(alone.Restore(state), std::runtime_error);
    ExpectRefusesCut(state, 3, [&](auto cut) { after.Restore(cut); });
}

}  // namespace
}  // namespace lull
