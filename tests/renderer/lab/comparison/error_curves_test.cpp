#include "renderer/lab/comparison/error_curves.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "stopping/rules/baselines.h"
#include "stopping/rules/rule_table.h"
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

TEST(CurveRules, HaveTheLadderAndEachKindAndCanAllBeRead) {
    const std::vector<std::string> rules = CurveRules(20, 10000);
    for (const std::string& rule : rules) EXPECT_NO_THROW(ParseRule(rule)) << rule;
    for (const char* known : {"fixed:20", "fixed:10000"})
        EXPECT_EQ(std::ranges::count(rules, known), 1) << known;
    for (const char* kind : {"entropy:", "dammertz:", "cycles:", "luxtile:", "lnoise:"})
        EXPECT_GE(std::ranges::count_if(
                      rules, [&](const std::string& rule) { return rule.starts_with(kind); }),
                  3)
            << kind;
}

TEST(MeasureCurves, GivesAPointForEachRule) {
    const PixelRect region{{0, 0}, {80, 80}};
    const auto fixed = [](int spp) {
        return [=](const BlockInfo&) { return MakeCriterion(FixedRule(spp)); };
    };
    const std::vector<MonitoredRule> rules = {{"image", "fixed:40", 0, fixed(40)},
                                              {"a", "fixed:20", 0, fixed(20)},
                                              {"b", "fixed:80", 0, fixed(80)},
                                              {"c", "dammertz:0.01:area", 0, [](const BlockInfo&) {
                                                   return MakeCriterion(DammertzRule(100));
                                               }}};
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
    Comparison comparison = BeginComparison(region, options.schedule);
    comparison.images = {TakeImage(monitored, rules, 0), TakeWholeImage(monitored)};
    Measure(&comparison);
    std::vector<CurvePoint> points = MeasureCurves(monitored, rules, 1, comparison);
    ASSERT_EQ(points.size(), 4u);
    EXPECT_EQ(points[0].setting, "40");
    EXPECT_EQ(points[0].figures.rmse, comparison.images[0].figures->rmse);
    EXPECT_EQ(points[2].rule, "fixed");
    EXPECT_EQ(points[2].setting, "80");
    EXPECT_EQ(points[2].spp, 80);
    EXPECT_EQ(points[3].setting, "0.01:area");
    EXPECT_EQ(points[3].spp, 20);
    EXPECT_EQ(points[3].figures.rmse, points[1].figures.rmse);
    EXPECT_LT(points[2].figures.relMse, points[1].figures.relMse);
    EXPECT_GT(points[2].seconds, points[1].seconds);
    EXPECT_GT(points[3].ruleSeconds, 0);

    // A picture for displays tells nothing of linear errors.
    comparison.images.back().isDisplay = true;
    points = MeasureCurves(monitored, rules, 1, comparison);
    EXPECT_TRUE(std::isnan(points[1].figures.rmse));
    EXPECT_EQ(points[1].figures.flip, points[3].figures.flip);
}

}  // namespace
}  // namespace lull
