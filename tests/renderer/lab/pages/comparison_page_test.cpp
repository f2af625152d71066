#include <gtest/gtest.h>

#include "renderer/lab/pages/comparison_page.h"
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
    EXPECT_TRUE(Contains(data["notes"][1].get<std::string>(), "2x2"));
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

}  // namespace
}  // namespace lull
