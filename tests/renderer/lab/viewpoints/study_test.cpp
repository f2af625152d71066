#include "renderer/lab/viewpoints/study.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/base/error.h"
#include "renderer/image/image_io.h"
#include "tests/renderer/files/test_files.h"

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
std::string ProblemOf(const TemporaryDirectory& folder) try {
    MakeStudy(FindPictures(folder.path.string(), "x"), 200, 0, 1.25);
    return "";
} catch (const Error& e) {
    return e.what();
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
    EXPECT_TRUE(Contains(ProblemOf(folder), "has no pictures"));
    WriteGrey(folder.File("a-20spp.png"), 8, 8, 0.5f);
    EXPECT_TRUE(Contains(ProblemOf(folder), "a-20spp.png: is the only picture"));
    WriteGrey(folder.File("a-40spp.png"), 8, 9, 0.5f);
    EXPECT_TRUE(Contains(ProblemOf(folder), "a-40spp.png: has 8x9 pixels"));
    WriteGrey(folder.File("b-20.png"), 8, 8, 0.5f);
    EXPECT_TRUE(Contains(ProblemOf(folder), "both of 20 spp"));
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

}  // namespace
}  // namespace lull
