// Renders with masks that raise the caution of blocks.
#include <sstream>

#include "renderer/image/image_io.h"
#include "tests/integration/run_lull.h"

namespace lull::importance_test {
namespace {

constexpr const char* kRender =
    "render scene.pbrt --resolution 120x80 --block 40 --quiet -o i.exr ";

// The left third of the mask is white, the next grey (128 of 255), the last black.
struct MaskDirectory : TemporaryDirectory {
    MaskDirectory() {
        Write("scene.pbrt", SceneText(kSphere));
        const std::vector<uint8_t> srgb = {255, 255, 255, 128, 128, 128, 0, 0, 0};
        WritePng(File("mask.png"), srgb, 3, 1);
    }

    // Returns the stops of the blocks, row by row.
    std::vector<int> Stops(const std::string& options) const {
        ExpectSuccess(*this, kRender + options);
        std::istringstream row(ReadBytes(File("i.thresholds.csv")));
        std::string word;
        std::getline(row, word, ';');  // the name
        std::vector<int> stops;
        while (std::getline(row, word, ';') && word != "\n") stops.push_back(std::stoi(word));
        return stops;
    }
};

// Two rows of three blocks stop by the caution of their column.
TEST(Importance, IsTheCautionOfBlocks) {
    const MaskDirectory directory;
    for (const std::string rule :
         {"--stop lnoise:0.4 ", "--stop entropy:0.4 ", "--stop learned "}) {
        const std::vector<int> by[] = {directory.Stops(rule + "--caution 2"),
                                       directory.Stops(rule + "--caution 1.5"),
                                       directory.Stops(rule)};
        const std::vector<int> stops = directory.Stops(rule + "--importance mask.png");
        ASSERT_EQ(stops.size(), 6u);
        for (size_t i = 0; i < 6; ++i) EXPECT_EQ(stops[i], by[i % 3][i]) << rule << i;
        EXPECT_NE(stops, by[0]) << rule;
        EXPECT_NE(stops, by[2]) << rule;
    }
    const std::string denoised = "--denoise --stop denoised:0.5 ";
    EXPECT_EQ(directory.Stops(denoised + "--importance mask.png")[0],
              directory.Stops(denoised + "--caution 2")[0]);
}

// A small sphere, here by its material, is seen in the middle of the three columns alone.
TEST(Importance, IsThatOfAnObject) {
    const MaskDirectory directory;
    directory.Write("scene.pbrt",
                    SceneText("MakeNamedMaterial \"ball\" \"string type\" \"matte\" "
                              "NamedMaterial \"ball\" Shape \"sphere\" \"float radius\" 0.2"));
    const std::string rule = "--stop lnoise:0.4 ";
    const std::vector<int> careful = directory.Stops(rule + "--caution 2"),
                           plain = directory.Stops(rule);
    const std::vector<int> stops = directory.Stops(rule + "--importance ball=2");
    for (size_t i = 0; i < 6; ++i) EXPECT_EQ(stops[i], i % 3 == 1 ? careful[i] : plain[i]) << i;
    const std::string start = "render scene.pbrt -o out.exr --stop lnoise ";
    ExpectFailure(directory, start + "--importance cube=2",
                  {"--importance", "'cube'", "cryptomatte"});
    ExpectFailure(directory, start + "--importance ball=0", {"--importance", "0.01"}, 2);
}

// Each eye of a pair has the whole mask, and a crop its part.
TEST(Importance, CoversTheImage) {
    const MaskDirectory directory;
    const std::string pair = "--stop lnoise:0.4 --stereo 0.1 ";
    const std::vector<int> careful = directory.Stops(pair + "--caution 2"),
                           plain = directory.Stops(pair);
    const std::vector<int> stops = directory.Stops(pair + "--importance mask.png");
    ASSERT_EQ(stops.size(), 12u);
    for (const size_t i : {0, 3, 6, 9}) {
        EXPECT_EQ(stops[i], careful[i]) << i;
        EXPECT_EQ(stops[i + 2], plain[i + 2]) << i;
    }
    const std::string crop = "--stop lnoise:0.4 --crop 80,120,0,80px ";
    EXPECT_EQ(directory.Stops(crop + "--importance mask.png"), directory.Stops(crop));
}

TEST(Importance, IsPartOfTheRuleWhereARenderResumes) {
    const MaskDirectory directory;
    const std::string rule = "--stop lnoise:0.4 ";
    directory.Stops(rule + "--importance mask.png");
    const std::string whole = directory.Bytes("i.thresholds.csv");
    const std::string keep = rule + "--checkpoint c.h5 --resume --keep-checkpoint ";
    directory.Stops(keep + "--max-spp 20");  // before the first block stops
    EXPECT_HAS(RunLull(directory, kRender + keep + "--importance mask.png").err,
               "with another rule");
    EXPECT_EQ(directory.Bytes("i.thresholds.csv"), whole);
}

TEST(Importance, IsRefusedWhereItHasNoEffect) {
    const MaskDirectory directory;
    const std::string start = "render scene.pbrt -o out.exr ";
    ExpectFailure(directory, start + "--spp 20 --importance mask.png", {"--importance", "caution"},
                  2);
    ExpectFailure(directory, start + "--importance none.png", {"none.png"});
}

}  // namespace
}  // namespace lull::importance_test
