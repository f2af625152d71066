#include "renderer/lab/comparison/bench.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "renderer/base/error.h"
#include "stopping/rules/baselines.h"
#include "stopping/rules/rule_table.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/render/synthetic_samples.h"

namespace lull {
namespace {

TEST(FixedLadder, GoesFromTheFirstPassToTheCap) {
    EXPECT_EQ(FixedLadder(20, 200), (std::vector<int>{20, 40, 60, 100, 160, 200}));
    EXPECT_EQ(FixedLadder(20, 20), (std::vector<int>{20}));
    EXPECT_EQ(FixedLadder(20, 5), (std::vector<int>{5}));
    const std::vector<int> full = FixedLadder(20, 10000);
    EXPECT_EQ(full.back(), 10000);
    EXPECT_LT(full.size(), 20u);
}

TEST(BenchRules, HaveTheLadderAndEachKindAndCanAllBeRead) {
    const std::vector<std::string> rules = BenchRules(20, 10000);
    for (const std::string& rule : rules) EXPECT_NO_THROW(ParseRule(rule)) << rule;
    for (const char* known : {"fixed:20", "fixed:10000"})
        EXPECT_EQ(std::ranges::count(rules, known), 1) << known;
    for (const char* kind : {"entropy:", "dammertz:", "cycles:", "luxtile:", "lnoise:"})
        EXPECT_GE(std::ranges::count_if(
                      rules, [&](const std::string& rule) { return rule.starts_with(kind); }),
                  3)
            << kind;
}

TEST(MeasurePoints, GivesAPointForEachRule) {
    const PixelRect region{{0, 0}, {80, 80}};
    const std::vector<MonitoredRule> rules = {
        {"a", "fixed:20", 0, [](const BlockInfo&) { return MakeCriterion(FixedRule(20)); }},
        {"b", "fixed:80", 0, [](const BlockInfo&) { return MakeCriterion(FixedRule(80)); }},
        {"c", "dammertz:0.01:area", 0,
         [](const BlockInfo&) { return MakeCriterion(DammertzRule(100)); }}};
    RenderOptions options;
    options.schedule.blockSize = 40;
    options.schedule.cap = 160;
    Film film(region);
    std::vector<BlockHistory> histories(4);
    options.makeCriterion = MakeMonitors(rules, region, options.schedule,
                                         {.snapshots = true, .goesOn = true}, &histories);
    const RenderContext context{.source = SyntheticSample, .film = &film};
    const RenderResult result = Render(context, options);
    const MonitoredRender monitored{context, options, result, histories};
    int calls = 0;
    const std::vector<BenchPoint> points =
        MeasurePoints(monitored, rules, TakeWholeImage(monitored).image, {}, 2, [&] { ++calls; });
    ASSERT_EQ(points.size(), 3u);
    EXPECT_EQ(calls, 3);
    EXPECT_EQ(points[1].rule, "fixed");
    EXPECT_EQ(points[1].setting, "80");
    EXPECT_EQ(points[1].spp, 80);
    EXPECT_EQ(points[2].setting, "0.01:area");
    EXPECT_EQ(points[2].spp, 20);
    EXPECT_EQ(points[2].figures.rmse, points[0].figures.rmse);
    EXPECT_LT(points[1].figures.relMse, points[0].figures.relMse);
    EXPECT_GT(points[1].seconds, points[0].seconds);
    EXPECT_GT(points[2].ruleSeconds, 0);
    EXPECT_DOUBLE_EQ(points[2].seconds, points[2].threadSeconds / 2);
}

TEST(BenchCsv, HasALineForEachPoint) {
    BenchPoint point;
    point.rule = "dammertz";
    point.setting = "0.02";
    point.sampler = "sobol";
    point.spp = 64;
    point.figures.ssim = 0.5;
    point.figures.visibleDifference = 2.5;
    const std::string csv = BenchCsv({point});
    EXPECT_TRUE(csv.starts_with("rule,setting,sampler,spp,seconds,"));
    EXPECT_TRUE(Contains(csv, "\ndammertz,0.02,sobol,64,0,0,0,no,0,0,0.5,0,0,0,2.5\n")) << csv;
}

TEST(BenchCsv, LeavesOutWhatIsInfiniteOrUnknown) {
    const RgbImage image{1, 1, std::vector<float>(3, 0.5f)};
    const std::string csv = BenchCsv({MeasureExternal({"same", 1, "a.exr"}, image, image, {})});
    EXPECT_FALSE(Contains(csv, "nan")) << csv;
    EXPECT_FALSE(Contains(csv, "inf")) << csv;
    EXPECT_TRUE(Contains(csv, "no,0,0,,0,0,,0\n")) << csv;
}

TEST(ReadExternalImages, ReadsNamesSecondsAndFiles) {
    const TemporaryDirectory directory;
    const std::string csv = directory.Write(
        "others.csv", "name,seconds,file\npbrt-v3, 12.5 ,a.exr\r\n\nMitsuba 3,0.25,sub/b.exr\n");
    const std::vector<ExternalImage> images = ReadExternalImages(csv);
    ASSERT_EQ(images.size(), 2u);
    EXPECT_EQ(images[0].name, "pbrt-v3");
    EXPECT_EQ(images[0].seconds, 12.5);
    EXPECT_EQ(images[0].file, directory.File("a.exr"));
    EXPECT_EQ(images[1].file, directory.File("sub/b.exr"));
}

TEST(MeasureExternal, ComparesAnImageWithTheReference) {
    const RgbImage reference{4, 4, std::vector<float>(48, 0.5f)},
        image{4, 4, std::vector<float>(48, 0.75f)};
    const BenchPoint point = MeasureExternal({"other", 1.5, "a.exr"}, image, reference, {});
    EXPECT_EQ(point.rule, "other");
    EXPECT_EQ(point.seconds, 1.5);
    EXPECT_EQ(point.sampler, "");
    EXPECT_NEAR(point.figures.rmse, 0.25, 1e-6);
}

TEST(ReadExternalImages, NamesTheLineThatIsWrong) {
    const TemporaryDirectory directory;
    for (const char* line :
         {"a", "a,b", "a,b,c.exr", ",1,c.exr", "a,1,", "a,-1,c.exr", "a,nan,c.exr", "a,1s,c.exr"}) {
        const std::string csv = directory.Write("o.csv", std::string("x,1,y.exr\n") + line + "\n");
        EXPECT_TRUE(Contains(ErrorOf([&] { ReadExternalImages(csv); }), "o.csv:2: ")) << line;
    }
    EXPECT_NE(ErrorOf([&] { ReadExternalImages(directory.File("missing.csv")); }), "");
}

}  // namespace
}  // namespace lull
