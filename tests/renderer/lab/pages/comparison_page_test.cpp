#include <gtest/gtest.h>

#include "renderer/image/image_io.h"
#include "renderer/lab/pages/comparison_page.h"
#include "renderer/pages/html_page.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/pages/page_data.h"

namespace lull {
namespace {

ComparisonReport TwoRows() {
    ComparisonReport report;
    report.title = "two";
    Comparison& comparison = report.comparison;
    comparison.region = {{10, 20}, {50, 60}};
    comparison.blocks = {{{10, 20}, {30, 60}}, {{30, 20}, {50, 60}}};
    comparison.cap = 100;
    comparison.hasReference = true;
    const float values[3] = {0.45f, 0.5f, 0.5f};
    const char* const names[3] = {"automatic", "human", "reference"};
    for (int i = 0; i < 3; ++i) {
        ComparedImage& image = comparison.images.emplace_back();
        image.name = names[i];
        image.image = {40, 40, std::vector<float>(40 * 40 * 3, values[i])};
    }
    comparison.images[0].costs = {{.spp = 20, .seconds = 2, .ruleSeconds = 1},
                                  {.spp = 50, .seconds = 10}};
    comparison.images[1].costs = {{.spp = 60, .seconds = 6}, {.spp = 40, .seconds = 8}};
    comparison.images[2].costs = {{.spp = 100, .seconds = 10}, {.spp = 100, .seconds = 20}};
    report.verifications = {
        {.threads = 2, .wallSeconds = 7, .seconds = 12, .ruleSeconds = 1, .samePixels = true}};
    Measure(&comparison);
    return report;
}

TEST(ComparisonJson, SaysWhatWasSaved) {
    const Json json = ComparisonJson(TwoRows());
    EXPECT_EQ(json["reference"], "reference");
    EXPECT_EQ(json["atCap"]["samples"], 40 * 40 * 100);
    EXPECT_EQ(json["atCap"]["seconds"], 30);
    const Json& automatic = json["images"][0];
    EXPECT_DOUBLE_EQ(automatic["saved"]["samples"], 0.65);
    EXPECT_DOUBLE_EQ(automatic["saved"]["seconds"], 1 - 13. / 30);
    EXPECT_EQ(automatic["saved"]["estimated"], false);
    EXPECT_EQ(automatic["blocks"][1]["spp"], 50);
    EXPECT_EQ(json["blocks"][1]["x"], 20);  // within the image
    EXPECT_EQ(json["againstHuman"]["earlier"], 1);
    EXPECT_EQ(json["againstHuman"]["later"], 1);
    EXPECT_EQ(json["againstHuman"]["spp"], Json({-40, 10}));
    EXPECT_EQ(json["againstHuman"]["meanDistance"], 25);
    // The human image is the reference itself: no error, no noise, and no infinity in JSON.
    EXPECT_EQ(json["images"][1]["figures"]["rmse"], 0);
    EXPECT_TRUE(json["images"][1]["figures"]["psnr"].is_null());
}

// The saving in seconds, 1 - 7 / (30 / 2), over that in samples, 0.65.
TEST(ComparisonJson, SaysHowMuchOfTheSavingIsKept) {
    const Json v = ComparisonJson(TwoRows())["verifications"][0];
    EXPECT_DOUBLE_EQ(v["wallSecondsToCap"], 15);
    EXPECT_NEAR(v["savedWall"], 1 - 7. / 15, 1e-12);
    EXPECT_NEAR(v["kept"], (1 - 7. / 15) / 0.65, 1e-12);
    EXPECT_NEAR(v["ruleShare"], 1. / 13, 1e-12);
}

TEST(CostAtCap, IsEstimatedWhereNothingWentThatFar) {
    ComparisonReport report = TwoRows();
    report.comparison.images.pop_back();
    const TotalCost cost = CostAtCap(report.comparison);
    EXPECT_TRUE(cost.isEstimated);
    EXPECT_DOUBLE_EQ(cost.seconds, 6 / 60. * 100 + 10 / 50. * 100);
}

TEST(MakeComparisonPage, HasPicturesAndErrorMaps) {
    const Json data = DataOf(MakeComparisonPage(TwoRows()));
    ASSERT_EQ(data["images"].size(), 3u);
    for (const Json& image : data["images"])
        EXPECT_TRUE(image["src"].get<std::string>().starts_with("data:image/png"));
    for (const char* map : {"flipSrc", "visibleDifferenceSrc"}) {
        EXPECT_TRUE(data["images"][0].contains(map));
        EXPECT_FALSE(data["images"][2].contains(map));
    }
}

// Whatever is compared, the page can be opened.
TEST(MakeComparisonPage, ShowsLargeImagesByTheirMeans) {
    ComparisonReport report = TwoRows();
    report.notes = {"a note"};
    report.comparison.region = {{10, 20}, {10 + 2901, 20 + 1601}};
    for (ComparedImage& image : report.comparison.images) {
        image.image = {2901, 1601, std::vector<float>(2901 * 1601 * 3, 0.5f)};
        if (!image.flip.empty()) image.flip.assign(2901 * 1601, 0.25f);
        if (!image.visibleDifference.empty()) image.visibleDifference.assign(2901 * 1601, 7);
    }
    const Json data = DataOf(MakeComparisonPage(report));
    EXPECT_EQ(data["width"], 2901);  // blocks are where they are
    EXPECT_EQ(data["notes"][0], "a note");
    EXPECT_HAS(data["notes"][1].get<std::string>(), "2x2");
    for (const Json& image : data["images"]) EXPECT_EQ(PictureSize(image["src"]), Vec2i(1451, 801));
    EXPECT_EQ(PictureSize(data["images"][0]["flipSrc"]), Vec2i(1451, 801));
    EXPECT_EQ(PictureSize(data["images"][0]["visibleDifferenceSrc"]), Vec2i(1451, 801));
    EXPECT_EQ(PictureSize(PictureUri({3, 2, std::vector<float>(18)})), Vec2i(3, 2));
    EXPECT_EQ(DataOf(MakeComparisonPage(TwoRows()))["notes"].size(), 0u);
}

TEST(ComparisonJson, HasThePointsOfCurves) {
    ComparisonReport report = TwoRows();
    report.curvePoints = {{.rule = "fixed", .setting = "20", .spp = 20, .figures = {}}};
    report.curvePoints[0].figures.psnr = std::numeric_limits<double>::infinity();
    const Json json = ComparisonJson(report), point = json["errorCurves"]["points"][0];
    EXPECT_EQ(point["rule"], "fixed");
    EXPECT_EQ(point["setting"], "20");
    EXPECT_TRUE(point["psnr"].is_null());
    EXPECT_FALSE(ComparisonJson(TwoRows()).contains("errorCurves"));
}

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
        EXPECT_HAS(page, std::string(EmbeddedFile(name))) << name;
    }
    for (const char* reaching :
         {"src=\"http", "href=\"http", "@import", "url(", "fetch(", "import(", "XMLHttp"})
        EXPECT_FALSE(Contains(page, reaching)) << reaching;
    EXPECT_HAS(page, "default-src 'none'");
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
        EXPECT_HAS(ErrorOf([&] { ReadStudyPage(path); }), "other.html: not ");
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
    EXPECT_HAS(page, reference);
    EXPECT_HAS(page, "bad.json");
    EXPECT_FALSE(Contains(page, "\"</script>"));
    viewpoint.study = "another";
    EXPECT_FALSE(Contains(MakeCollectedPage(collected, json), reference));
    EXPECT_HAS(MakeCollectedPage(collected, nullptr), "\"mean\":40");
}

}  // namespace

}  // namespace lull
