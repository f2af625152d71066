#include "renderer/lab/viewpoints/study.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/base/error.h"
#include "renderer/image/image_io.h"
#include "stopping/rules/baselines.h"
#include "stopping/signals/lightness.h"
#include "tests/renderer/files/test_files.h"
#include "tests/stopping/cut_states.h"

namespace lull {
namespace {

// Writes a grey picture, as PNG or EXR.
void WriteGrey(const std::string& path, int width, int height, float linear) {
    const size_t pixels = size_t(width) * size_t(height);
    if (path.ends_with(".png")) {
        WritePng(path, std::vector<Rgb>(pixels, Rgb::Constant(linear)), width, height);
        return;
    }
    ExrImage image;
    image.width = width;
    image.height = height;
    for (const char* name : {"R", "G", "B"})
        image.channels.push_back({name, std::vector<float>(pixels, linear)});
    WriteExr(path, image);
}

// Returns what reading a folder throws.
std::string ProblemOf(const TemporaryDirectory& folder) {
    return ErrorOf([&] { MakeStudy(FindPictures(folder.path.string(), "x"), 200, 0, 1.25); });
}

TEST(SppInName, IsTheNumberThatSaysSo) {
    EXPECT_EQ(SppInName("room-40spp.png"), 40);
    EXPECT_EQ(SppInName("room2_40_SPP_final3.png"), 40);
    EXPECT_EQ(SppInName("p3d_kitchen-view0_00120.png"), 120);
    EXPECT_EQ(SppInName("spp-0080.v2.exr"), 80);
    EXPECT_EQ(SppInName("640x480-spp.png"), 480);
    EXPECT_EQ(SppInName("room.png"), 0);
    EXPECT_EQ(SppInName("room-0.png"), 0);
    EXPECT_EQ(SppInName("room-99999999999spp.png"), 0);
    EXPECT_EQ(SppInName("spp.png"), 0);
}

TEST(MakeStudy, CutsPicturesIntoBlocksAtTheLevelsOfALadder) {
    const TemporaryDirectory folder;
    for (const int spp : {20, 25, 40, 80, 160})
        WriteGrey(folder.File(fmt::format("a-{}spp.png", spp)), 50, 30, 0.5f);
    WriteGrey(folder.File("a-320spp.exr"), 50, 30, 0.25f);
    const Study study = MakeStudy(FindPictures(folder.path.string(), "a"), 40, 5, 1.25);
    EXPECT_EQ(study.levels, (std::vector<int>{20, 40, 80, 160, 320}));
    EXPECT_EQ(study.width, 50);
    ASSERT_EQ(study.blocks.size(), 2u);
    EXPECT_EQ(study.blocks[1].pixels, (PixelRect{{40, 0}, {50, 30}}));
    ASSERT_EQ(study.blocks[1].pictures.size(), 5u);
    // What a display shows of 0.5 and 0.25, whatever the format.
    EXPECT_EQ(study.blocks[1].pictures[0], DisplayPixels(10 * 30 * 3, 188));
    EXPECT_EQ(study.blocks[1].pictures[4], DisplayPixels(10 * 30 * 3, 137));
    EXPECT_NEAR(NoiseOf(study.blocks[0], 0), 76.069 - 57.075, 0.3);
    EXPECT_EQ(NoiseOf(study.blocks[0], 4), 0);
}

TEST(MakeStudy, NamesWhatDoesNotFit) {
    const TemporaryDirectory folder;
    EXPECT_HAS(ProblemOf(folder), "has no pictures");
    WriteGrey(folder.File("a-20spp.png"), 8, 8, 0.5f);
    EXPECT_HAS(ProblemOf(folder), "a-20spp.png: is the only picture");
    WriteGrey(folder.File("a-40spp.png"), 8, 9, 0.5f);
    EXPECT_HAS(ProblemOf(folder), "a-40spp.png: has 8x9 pixels");
    WriteGrey(folder.File("b-20.png"), 8, 8, 0.5f);
    EXPECT_HAS(ProblemOf(folder), "both of 20 spp");
    folder.Write("notes.txt", "x");
    EXPECT_TRUE(Contains(ProblemOf(folder), "notes.txt: has no spp in its name") ||
                Contains(ProblemOf(folder), "both of 20 spp"));
    EXPECT_THROW(FindPictures(folder.File("no such")), Error);
}

TEST(StudyId, TellsStudiesApart) {
    Study study{.viewpoint = "a", .width = 1, .height = 1, .levels = {20, 40}};
    study.blocks = {{{{0, 0}, {1, 1}}, {DisplayPixels(3, 1), DisplayPixels(3, 2)}}};
    const std::string id = StudyId(study);
    EXPECT_EQ(id.size(), 16u);
    EXPECT_EQ(StudyId(study), id);
    Study other = study;
    other.blocks[0].pictures[1][2] = 3;
    EXPECT_NE(StudyId(other), id);
    other = study;
    other.levels[1] = 60;
    EXPECT_NE(StudyId(other), id);
    other = study;
    other.viewpoint = "b";
    EXPECT_NE(StudyId(other), id);
}

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
