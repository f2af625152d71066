#include "renderer/lab/pages/comparison_page.h"

#include <gtest/gtest.h>

#include "renderer/image/image_io.h"
#include "renderer/pages/html_page.h"
#include "tests/renderer/files/test_files.h"

namespace lull {
namespace {

Study TwoBlocks() {
    Study study{.viewpoint = "<room>", .width = 3, .height = 1, .levels = {20, 40}};
    study.blocks = {{{{0, 0}, {2, 1}}, {DisplayPixels(6, 10), DisplayPixels(6, 200)}},
                    {{{2, 0}, {3, 1}}, {DisplayPixels(3, 90), DisplayPixels(3, 90)}}};
    return study;
}

TEST(MakeStudyPage, NeedsNothingElseAndAsksForNothing) {
    const std::string page = MakeStudyPage(TwoBlocks(), {});
    for (const char* name :
         {"study.css", "adjust.js", "session.js", "pictures.js", "adjust_view.js", "practice.js",
          "check.js", "study.js", "format.js"}) {
        ASSERT_FALSE(EmbeddedFile(name).empty()) << name;
        EXPECT_TRUE(Contains(page, std::string(EmbeddedFile(name)))) << name;
    }
    for (const char* reaching :
         {"src=\"http", "href=\"http", "@import", "url(", "fetch(", "import(", "XMLHttp"})
        EXPECT_FALSE(Contains(page, reaching)) << reaching;
    EXPECT_TRUE(Contains(page, "default-src 'none'"));
    EXPECT_FALSE(Contains(page, "{{"));
    EXPECT_FALSE(Contains(page, "<room>"));  // a name is no markup
}

TEST(MakeStudyPage, HoldsWhatPeopleAreToldAndShown) {
    const TemporaryDirectory folder;
    const Study study = TwoBlocks();
    const std::string page = folder.Write("study.html", MakeStudyPage(study, {.repeats = 0.5}));
    const Json json = ReadStudyPage(page);
    EXPECT_EQ(json["id"], StudyId(study));
    EXPECT_EQ(json["viewpoint"], "<room>");
    EXPECT_EQ(json["repeats"], 0.5);
    EXPECT_EQ(json["levels"], (std::vector<int>{20, 40}));
    EXPECT_EQ(json["blocks"][1]["x"], 2);
    EXPECT_GT(json["blocks"][0]["noise"][0], 50);
    EXPECT_EQ(json["blocks"][0]["noise"][1], 0);
    ASSERT_EQ(json["references"].size(), 2u);
    EXPECT_EQ(json["references"][0],
              "data:image/png;base64," + Base64(EncodePng(DisplayPixels(6, 200), 2, 1)));
}

TEST(ReadStudyPage, RefusesOtherPages) {
    const TemporaryDirectory folder;
    const std::string page = MakeStudyPage(TwoBlocks(), {});
    std::string huge = page;  // a width that no int can hold
    huge.insert(huge.find("\"width\":") + 8, "99999999999");
    std::string unnamed = page;
    unnamed.replace(unnamed.find("\"id\":"), 5, "\"di\":");
    for (const std::string& text :
         {std::string(), std::string("<html></html>"), page.substr(0, page.find("\"levels\"")),
          page.substr(0, page.find("pictures-1")), huge, unnamed}) {
        const std::string path = folder.Write("other.html", text);
        EXPECT_TRUE(Contains(ErrorOf([&] { ReadStudyPage(path); }), "other.html: not "));
    }
    EXPECT_THROW(ReadStudyPage(folder.File("none.html")), Error);
}

TEST(EncodePng, KeepsDisplayPixelsAsTheyAre) {
    const TemporaryDirectory folder;
    DisplayPixels pixels;
    for (int i = 0; i < 5 * 4 * 3; ++i) pixels.push_back(uint8_t(i * 37));
    const std::vector<std::byte> png = EncodePng(pixels, 5, 4);
    const std::string path = folder.Write(
        "a.png", std::string_view(reinterpret_cast<const char*>(png.data()), png.size()));
    const Image image = ReadImage(path);
    EXPECT_EQ(image.width, 5);
    EXPECT_EQ(image.channels, 3);
    EXPECT_EQ(std::get<std::vector<uint8_t>>(image.texels), pixels);
    EXPECT_THROW(EncodePng(pixels, 5, 5), Error);
}

TEST(MakeCollectedPage, ShowsTheImageOfItsStudy) {
    const TemporaryDirectory folder;
    const Study study = TwoBlocks();
    const Json json = ReadStudyPage(folder.Write("study.html", MakeStudyPage(study, {})));
    Collected collected;
    CollectedViewpoint& viewpoint = collected.viewpoints.emplace_back();
    viewpoint.name = study.viewpoint;
    viewpoint.study = StudyId(study);
    viewpoint.levels = study.levels;
    viewpoint.observers = 1;
    viewpoint.blocks.resize(2);
    viewpoint.blocks[0].mean = 40;
    viewpoint.blocks[1].mean = 20;
    collected.refused = {{"bad.json", "</script>"}};
    const std::string reference = json["references"][0].get<std::string>();
    const std::string page = MakeCollectedPage(collected, json);
    EXPECT_TRUE(Contains(page, reference));
    EXPECT_TRUE(Contains(page, "bad.json"));
    EXPECT_FALSE(Contains(page, "\"</script>"));
    viewpoint.study = "another";
    EXPECT_FALSE(Contains(MakeCollectedPage(collected, json), reference));
    EXPECT_TRUE(Contains(MakeCollectedPage(collected, nullptr), "\"mean\":40"));
}

}  // namespace
}  // namespace lull
