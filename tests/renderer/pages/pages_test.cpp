#include <gtest/gtest.h>

#include "renderer/pages/bench_page.h"
#include "renderer/pages/comparison_page.h"
#include "renderer/pages/embedded.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/film/add_sample.h"

namespace lull {
namespace {

// Returns the data that a page holds.
Json DataOf(const std::string& page) {
    const std::string open = "<script id=\"data\" type=\"application/json\">";
    const size_t begin = page.find(open) + open.size();
    return Json::parse(page.substr(begin, page.find("</script>", begin) - begin));
}

ComparisonReport TwoImages() {
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

TEST(MakePage, HoldsAllFilesAndNeedsNoOther) {
    const std::string page = MakePage({{"title", "x"}});
    for (const char* name :
         {"page.css", "page.js", "format.js", "charts.js", "viewer.js", "tables.js", "bench.js",
          "sentence.js", "uPlot.iife.min.js", "uPlot.min.css"}) {
        ASSERT_FALSE(EmbeddedFile(name).empty()) << name;
        EXPECT_NE(page.find(EmbeddedFile(name)), std::string::npos) << name;
    }
    EXPECT_EQ(EmbeddedFile("no such file"), "");
    EXPECT_TRUE(
        Contains(page, "http-equiv=\"Content-Security-Policy\" content=\"default-src 'none';"));
    for (const char* reaching :
         {"src=\"http", "href=\"http", "@import", "url(", "fetch(", "import("})
        EXPECT_EQ(page.find(reaching), std::string::npos) << reaching;
    for (const char* name : {"page.css", "page.js", "data"})
        EXPECT_FALSE(Contains(page, std::string("{{") + name + "}}"));
}

TEST(MakePage, CannotBeBrokenByItsData) {
    const std::string evil = "</script><script>alert(1)</script><!-- {{page.js}} \xff";
    const std::string page = MakePage({{"title", evil}});
    EXPECT_FALSE(Contains(page, "alert(1)</script>"));
    const std::string title = DataOf(page)["title"];
    EXPECT_TRUE(title.starts_with("</script><script>alert(1)</script><!-- {{page.js}} "));
}

TEST(PictureUri, IsAPngInBase64) {
    const std::string uri = PictureUri({2, 1, {0, 0, 0, 1, 1, 1}});
    EXPECT_TRUE(uri.starts_with("data:image/png;base64,iVBORw0KGgo"));
    EXPECT_EQ((uri.size() - std::string("data:image/png;base64,").size()) % 4, 0u);
    EXPECT_TRUE(MapUri(std::vector<float>{0, 0.5f, 1}, 3, 1).starts_with("data:image/png;base64,"));
}

TEST(ComparisonJson, SaysWhatWasSaved) {
    const Json json = ComparisonJson(TwoImages());
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
    const Json v = ComparisonJson(TwoImages())["verifications"][0];
    EXPECT_DOUBLE_EQ(v["wallSecondsToCap"], 15);
    EXPECT_NEAR(v["savedWall"], 1 - 7. / 15, 1e-12);
    EXPECT_NEAR(v["kept"], (1 - 7. / 15) / 0.65, 1e-12);
    EXPECT_NEAR(v["ruleShare"], 1. / 13, 1e-12);
}

TEST(CostAtCap, IsEstimatedWhereNothingWentThatFar) {
    ComparisonReport report = TwoImages();
    report.comparison.images.pop_back();
    const TotalCost cost = CostAtCap(report.comparison);
    EXPECT_TRUE(cost.isEstimated);
    EXPECT_DOUBLE_EQ(cost.seconds, 6 / 60. * 100 + 10 / 50. * 100);
}

TEST(MakeComparisonPage, HasPicturesAndErrorMaps) {
    const Json data = DataOf(MakeComparisonPage(TwoImages()));
    ASSERT_EQ(data["images"].size(), 3u);
    for (const Json& image : data["images"])
        EXPECT_TRUE(image["src"].get<std::string>().starts_with("data:image/png"));
    EXPECT_TRUE(data["images"][0].contains("flipSrc"));
    EXPECT_FALSE(data["images"][2].contains("flipSrc"));
}

// Returns how many pixels a picture has: its header is known before it is decoded.
Vec2i SizeOf(const std::string& uri) {
    const std::string head = "data:image/png;base64,", digits = uri.substr(head.size(), 32);
    std::string bytes;
    for (size_t i = 0, bits = 0, have = 0; i < digits.size(); ++i) {
        const char c = digits[i];
        bits = bits << 6 | size_t(c >= 'a'   ? c - 'a' + 26
                                  : c >= 'A' ? c - 'A'
                                  : c >= '0' ? c - '0' + 52
                                  : c == '+' ? 62
                                             : 63);
        if ((have += 6) >= 8) bytes += char(bits >> (have -= 8) & 255);
    }
    const auto number = [&](size_t at) {
        return int(uint8_t(bytes[at + 2])) << 8 | int(uint8_t(bytes[at + 3]));
    };
    return {number(16), number(20)};
}

// Whatever is compared, the page can be opened.
TEST(MakeComparisonPage, ShowsLargeImagesByTheirMeans) {
    ComparisonReport report = TwoImages();
    report.notes = {"a note"};
    report.comparison.region = {{10, 20}, {10 + 2901, 20 + 1601}};
    for (ComparedImage& image : report.comparison.images) {
        image.image = {2901, 1601, std::vector<float>(2901 * 1601 * 3, 0.5f)};
        if (!image.flip.empty()) image.flip.assign(2901 * 1601, 0.25f);
    }
    const Json data = DataOf(MakeComparisonPage(report));
    EXPECT_EQ(data["width"], 2901);  // blocks are where they are
    EXPECT_EQ(data["notes"][0], "a note");
    EXPECT_TRUE(Contains(data["notes"][1].get<std::string>(), "2x2"));
    for (const Json& image : data["images"]) EXPECT_EQ(SizeOf(image["src"]), Vec2i(1451, 801));
    EXPECT_EQ(SizeOf(data["images"][0]["flipSrc"]), Vec2i(1451, 801));
    EXPECT_EQ(SizeOf(PictureUri({3, 2, std::vector<float>(18)})), Vec2i(3, 2));
    EXPECT_EQ(DataOf(MakeComparisonPage(TwoImages()))["notes"].size(), 0u);
}

TEST(MakeBenchPage, HasThePoints) {
    BenchPoint point;
    point.rule = "fixed";
    point.setting = "20";
    point.sampler = "sobol";
    point.spp = 20;
    point.figures.psnr = std::numeric_limits<double>::infinity();
    Provenance provenance;
    provenance.schedule.cap = 100;
    const Json data = DataOf(MakeBenchPage("room", provenance, {point}, {"sobol"},
                                           {2, 2, std::vector<float>(12)}, {"a note"}));
    EXPECT_EQ(data["bench"]["points"][0]["rule"], "fixed");
    EXPECT_TRUE(data["bench"]["points"][0]["psnr"].is_null());
    EXPECT_EQ(data["notes"][0], "a note");
}

TEST(PagePicture, IsTheImageWhereThatIsSmall) {
    EXPECT_EQ(PagePictureScale(2048, 2048), 1);
    EXPECT_EQ(PagePictureScale(3840, 2160), 2);
    EXPECT_EQ(PagePictureScale(7680, 4320), 3);
    Film film({{2, 1}, {5, 3}});
    AddTo(&film, {4, 2}, Rgb(1, 2, 3));
    EXPECT_EQ(PagePicture(film).values, film.MeanImage());
}

TEST(PagePicture, IsOfMeansWhereTheImageIsLarge) {
    const PixelRect region{{10, 20}, {10 + 2901, 20 + 1601}};
    Film film(region);
    AddTo(&film, {10, 20}, Rgb(4, 8, 0));
    AddTo(&film, {11, 21}, Rgb(0, 0, 12));
    AddTo(&film, region.max - Vec2i(1, 1), Rgb(5, 6, 7));  // alone in its place
    const RgbImage picture = PagePicture(film);
    ASSERT_EQ(picture.width, 1451);
    ASSERT_EQ(picture.height, 801);
    ASSERT_EQ(picture.values.size(), size_t(1451 * 801 * 3));
    EXPECT_EQ(std::vector(picture.values.begin(), picture.values.begin() + 4),
              std::vector<float>({1, 2, 3, 0}));
    EXPECT_EQ(std::vector(picture.values.end() - 3, picture.values.end()),
              std::vector<float>({5, 6, 7}));
    RenderResult result;
    Provenance provenance;
    provenance.scene = "a.pbrt";
    const Json data = DataOf(MakeRenderPage(provenance, result, film, {}, {}, nullptr));
    EXPECT_EQ(data["width"], 2901);
    EXPECT_NE(data["notes"][0].get<std::string>().find("2x2"), std::string::npos);
}

TEST(MakeRenderPage, HasCurvesAndDecisions) {
    RenderResult result;
    result.blocks.resize(1);
    result.blocks[0].block = {
        .pixels = {{4, 4}, {8, 8}}, .spp = 20, .stopped = true, .stoppedByVote = true};
    result.blocks[0].decisions = {{20, {.stop = true, .judged = true, .value = 1, .threshold = 2}}};
    std::vector<BlockHistory> histories(1);
    histories[0].curves = {{20}, {0.5f}, {1.5f}};
    Provenance provenance;
    provenance.scene = "rooms/hall/scene.pbrt";
    provenance.criterion = "lnoise:2";
    provenance.schedule.cap = 100;
    const Film film({{4, 4}, {8, 8}});
    const Json data =
        DataOf(MakeRenderPage(provenance, result, film, histories, {{"odd", 2}}, nullptr));
    EXPECT_EQ(data["kind"], "render");
    EXPECT_EQ(data["title"], "hall");
    EXPECT_EQ(data["blocks"][0]["x"], 0);
    EXPECT_EQ(data["blocks"][0]["curves"]["noise"][0], 1.5);
    EXPECT_EQ(data["blocks"][0]["decisions"]["value"][0], 1);
    EXPECT_EQ(data["images"][0]["blocks"][0]["spp"], 20);
    EXPECT_EQ(data["warnings"]["odd"], 2);
    EXPECT_EQ(data["images"].size(), 1);

    const DenoisedImage denoised{{4, 4, std::vector<float>(48, .5f)},
                                 std::vector<float>(16, .3f),
                                 {VisibleError{.estimate = .25, .upper = .5, .least = .125}}};
    const Json clean = DataOf(MakeRenderPage(provenance, result, film, histories, {}, &denoised));
    EXPECT_EQ(clean["images"].size(), 3);
    EXPECT_EQ(clean["images"][0]["label"], "denoised (lnoise:2)");
    EXPECT_EQ(clean["blocks"][0]["visibleError"]["upper"], .5);
}

}  // namespace
}  // namespace lull
