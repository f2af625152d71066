#include "renderer/lab/viewpoints/picture_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "renderer/base/error.h"
#include "renderer/image/image_io.h"
#include "renderer/lab/viewpoints/recorded_viewpoint.h"
#include "stopping/rules/rule_table.h"
#include "stopping/signals/lightness.h"
#include "tests/renderer/files/test_files.h"

namespace lull::picture_folder_test {
namespace {

// Writes pictures of 100x60 pixels whose noise falls with the spp; that of the right half is the
// larger.
void WritePictures(const TemporaryDirectory& folder, const std::vector<int>& spp) {
    for (const int n : spp) {
        std::mt19937 generator{unsigned(n)};
        std::normal_distribution<float> gauss;
        std::vector<Rgb> pixels;
        for (int i = 0; i < 100 * 60; ++i) {
            const int x = i % 100;
            const float noise = (x < 50 ? 0.2f : 1.f) / std::sqrt(float(n));
            pixels.push_back(Rgb::Constant(0.3f + 0.002f * float(x) + noise * gauss(generator)));
        }
        WritePng(folder.File(fmt::format("room-{}spp.png", n)), pixels, 100, 60);
    }
}

std::vector<int> Passes(int last) {
    std::vector<int> spp;
    for (int n = 20; n <= last; n += 20) spp.push_back(n);
    return spp;
}

TEST(PictureFolder, IsInTheOrderOfSpp) {
    const TemporaryDirectory folder;
    WritePictures(folder, {100, 20, 9});
    const PictureFolder found = FindPictures(folder.path.string());
    EXPECT_EQ(found.Spp(), (std::vector<int>{9, 20, 100}));
    EXPECT_EQ(found.name, folder.path.filename().string());
    EXPECT_EQ(FindPictures(folder.path.string() + "/").name, found.name);
    EXPECT_EQ(FindNamedPictures(folder.path.string() + ":attic").name, "attic");
    EXPECT_EQ(found.width, 100);
    EXPECT_THROW(FindNamedPictures(folder.path.string() + ":a;b"), Error);
}

TEST(PictureFolder, ReadsCodesAsADisplayShowsThem) {
    const TemporaryDirectory folder;
    std::vector<uint8_t> codes(16 * 16 * 3);
    for (size_t i = 0; i < codes.size(); ++i) codes[i] = uint8_t(i % 256);
    WritePng(folder.File("a_1.png"), codes, 16, 16);
    const RgbImage image = ReadPicture(FindPictures(folder.path.string()), 1);
    std::vector<uint8_t> shown(codes.size());
    EncodeSrgb8(image.values, shown);
    EXPECT_EQ(shown, codes);
}

TEST(PassOfPictures, IsThatOfRecordings) {
    EXPECT_EQ(PassOfPictures(Passes(400)), 20);
    EXPECT_EQ(PassOfPictures({20, 40, 60}), 20);
    EXPECT_EQ(PassOfPictures({5, 10, 15, 20}), 5);
    EXPECT_EQ(PassOfPictures({20, 40, 80}), 0);
    EXPECT_EQ(PassOfPictures({64, 128, 256}), 0);
    EXPECT_EQ(PassOfPictures({20, 50}), 0);
    EXPECT_EQ(PassOfPictures({20}), 0);
    std::vector<int> thinned = Passes(400);
    for (int n = 420; n <= 900; n += 40) thinned.push_back(n);
    EXPECT_EQ(PassOfPictures(thinned), 20);
}

TEST(RecordPictures, HoldsWhatPicturesShow) {
    const TemporaryDirectory folder;
    WritePictures(folder, {20, 40, 60});
    const PictureFolder found = FindPictures(folder.path.string(), "room");
    const ViewpointRecording viewpoint = RecordPictures(found, {.blockSize = 50});
    EXPECT_EQ(viewpoint.blockCount, 4);
    EXPECT_EQ(viewpoint.passSpp, 20);
    EXPECT_EQ(viewpoint.cap, 60);
    // The row of 10 pixels at the bottom is too small to be looked at.
    ASSERT_EQ(viewpoint.blocks.size(), 2u);
    const BlockRecording& block = viewpoint.blocks.at(1);
    EXPECT_EQ(block.spp, (std::vector<int>{20, 40, 60}));
    EXPECT_FALSE(HasHalves(block));
    EXPECT_THROW(block.Values(0, "noise"), std::invalid_argument);
    const EntropiesOfPicture entropies = MeasureEntropies(ReadPicture(found, 40), 50, 100, true);
    for (int i = 0; i < 100; ++i)
        EXPECT_FLOAT_EQ(block.Values(1, "h100")[size_t(i)],
                        float(entropies.blocks[1].subBlocks[size_t(i)].h));
    for (int i = 0; i < kAttributes; ++i)
        EXPECT_FLOAT_EQ(block.Values(1, "attributes26")[size_t(i)],
                        float(entropies.blocks[1].attributes[size_t(i)]));
    EXPECT_GT(entropies.blocks[1].mean.h, entropies.blocks[0].mean.h);  // more noise
    // A limit ends the record of a block at the first picture that reaches it.
    const ViewpointRecording part =
        RecordPictures(found, {.blockSize = 50, .limits = {30, 0, 0, 0}});
    ASSERT_EQ(part.blocks.size(), 1u);
    EXPECT_EQ(part.blocks.at(0).spp, (std::vector<int>{20, 40}));
    EXPECT_THROW(RecordPictures(found, {.blockSize = 30}), Error);
}

std::vector<PictureRule> Rules(const std::vector<std::string>& texts, int pass) {
    std::vector<PictureRule> rules;
    for (const std::string& text : texts)
        rules.push_back(
            {text, ParseRule(text, {.passSpp = pass, .blockCount = 2, .hasHalves = false})});
    return rules;
}

TEST(ComparePictures, TakesEachBlockWhereItStopped) {
    const TemporaryDirectory folder;
    WritePictures(folder, {50, 100, 200, 400});
    folder.Write("h.csv", "room;60;200;\n");
    const PictureFolder found = [&] {
        // The thresholds are no picture.
        std::filesystem::create_directory(folder.path / "p");
        for (const int n : {50, 100, 200, 400})
            std::filesystem::rename(folder.File(fmt::format("room-{}spp.png", n)),
                                    folder.File(fmt::format("p/room-{}spp.png", n)));
        return FindPictures(folder.File("p"));
    }();
    const ScheduleOptions schedule{.blockSize = 60};
    const PictureComparison compared = ComparePictures(
        found, schedule, Rules({"thresholds:" + folder.File("h.csv:room"), "fixed:10000"}, 0));
    const std::vector<ComparedImage>& images = compared.comparison.images;
    ASSERT_EQ(images.size(), 3u);
    EXPECT_EQ(images[0].costs[0].spp, 100);  // the first that has 60
    EXPECT_EQ(images[0].costs[1].spp, 200);
    EXPECT_EQ(images[1].costs[0].spp, 400);  // the last there is
    EXPECT_EQ(images[2].name, "reference");
    EXPECT_EQ(compared.comparison.cap, 400);
    const RgbImage at100 = ReadPicture(found, 100), at200 = ReadPicture(found, 200);
    for (int y = 0; y < 60; ++y)
        for (int x = 0; x < 100; ++x) {
            const size_t i = size_t(y * 100 + x) * 3;
            EXPECT_EQ(images[0].image.values[i], (x < 60 ? at100 : at200).values[i]);
        }
    EXPECT_EQ(images[1].image.values, images[2].image.values);
    EXPECT_TRUE(compared.blind.empty());
}

TEST(ComparePictures, TellsOfRulesThatLookAtNothing) {
    const TemporaryDirectory folder;
    WritePictures(folder, {50, 100, 200, 400});
    const PictureFolder found = FindPictures(folder.path.string());
    const ScheduleOptions schedule{.blockSize = 60};
    // It compares entropies at half the spp.
    EXPECT_TRUE(ComparePictures(found, schedule, Rules({"entropy:0.5"}, 0)).blind.empty());
    const std::string model = std::string(LULL_TESTS_DIR) + "/../stopping/models/entropy.h5";
    EXPECT_EQ(ComparePictures(found, schedule, Rules({"learned:" + model}, 0)).blind.size(), 1u);
    EXPECT_HAS(ErrorOf([&] { ComparePictures(found, schedule, Rules({"lnoise:0.5"}, 0)); }),
               "lnoise:0.5: the rule needs a half buffer");
}

}  // namespace
}  // namespace lull::picture_folder_test
