#include "renderer/lab/comparison/comparison.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "renderer/base/error.h"
#include "stopping/base/block_view.h"
#include "stopping/rules/baselines.h"
#include "stopping/rules/rule_table.h"
#include "tests/renderer/render/synthetic_samples.h"

namespace lull {
namespace {

// The blocks at the right are 20 pixels wide: too small to be judged, they follow a neighbour.
const PixelRect kRegion{{3, 5}, {123, 105}};

ScheduleOptions Schedule() { return {.blockSize = 50, .cap = 100}; }

std::vector<MonitoredRule> Rules() {
    const auto dammertz = [](const BlockInfo&) { return MakeCriterion(DammertzRule(0.5)); };
    const auto bySpp = [](const BlockInfo& info) {
        return MakeCriterion(FixedRule(20 + 20 * (info.index % 5)));
    };
    return {{"automatic", "dammertz:0.5", kSmallestVotingSide, dammertz},
            {"human", "thresholds:h.csv", 0, bySpp}};
}

RenderOptions Options() {
    RenderOptions options;
    options.schedule = Schedule();
    options.threads = 2;
    return options;
}

// A render as `lull render` would make it with that rule alone.
struct RenderAlone {
    Film film{kRegion};
    RenderResult result;

    explicit RenderAlone(const MonitoredRule& rule) {
        RenderOptions options = Options();
        options.schedule.smallestSide = rule.smallestSide;
        options.makeCriterion = rule.make;
        result = Render(Onto(&film, options));
    }
};

struct Observed {
    std::vector<MonitoredRule> rules = Rules();
    Film film{kRegion};
    RenderOptions options = Onto(&film, Options());
    std::vector<BlockHistory> histories;
    RenderResult result;

    explicit Observed(bool goesOn) {
        histories.resize(MakeBlocks(kRegion, options.schedule).size());
        options.makeCriterion =
            MakeMonitors(rules, kRegion, options.schedule,
                         {.snapshots = true, .noise = true, .goesOn = goesOn}, &histories);
        result = Render(options);
    }
    MonitoredRender Get() const { return {options, result, histories}; }
};

// What the whole design rests on: one render holds the images of all rules, to the last bit.
TEST(TakeImage, GivesTheBitsOfARenderByThatRuleAlone) {
    for (const bool goesOn : {true, false}) {
        const Observed observed(goesOn);
        for (size_t i = 0; i < observed.rules.size(); ++i) {
            const ComparedImage image = TakeImage(observed.Get(), observed.rules, i);
            const RenderAlone alone(observed.rules[i]);
            EXPECT_EQ(image.image.values, alone.film.MeanImage()) << goesOn << i;
            ASSERT_EQ(image.costs.size(), alone.result.blocks.size());
            for (size_t b = 0; b < image.costs.size(); ++b)
                EXPECT_EQ(image.costs[b].spp, alone.result.blocks[b].block.spp) << b;
        }
    }
}

TEST(TakeImage, TakesSomeBlocksBeforeTheCap) {
    const Observed observed(true);
    const ComparedImage image = TakeImage(observed.Get(), observed.rules, 1);
    EXPECT_EQ(image.costs[0].spp, 20);
    EXPECT_EQ(image.costs[3].spp, 80);
    for (const BlockResult& block : observed.result.blocks) EXPECT_EQ(block.block.spp, 100);
    EXPECT_LT(image.costs[0].seconds, observed.result.blocks[0].seconds);
}

TEST(TakeWholeImage, IsTheFilm) {
    const Observed observed(true);
    const ComparedImage image = TakeWholeImage(observed.Get());
    EXPECT_EQ(image.image.values, observed.film.MeanImage());
    EXPECT_EQ(image.noise.size(), size_t(kRegion.Area()));
}

// The image of a rule that was rendered alone is the one that was taken; another rule's is not.
TEST(VerificationOf, ComparesPixelsAndAddsUpSeconds) {
    const Observed observed(true);
    const ComparedImage taken = TakeImage(observed.Get(), observed.rules, 1);
    for (const size_t rule : {size_t(0), size_t(1)}) {
        const RenderAlone alone(observed.rules[rule]);
        const Verification verification = VerificationOf(alone.result, alone.film, taken);
        EXPECT_EQ(verification.samePixels, rule == 1);
        EXPECT_EQ(verification.threads, 2);
        double seconds = 0;
        for (const BlockResult& block : alone.result.blocks) seconds += block.seconds;
        EXPECT_EQ(verification.seconds, seconds);
        EXPECT_EQ(verification.wallSeconds, alone.result.progress.seconds);
    }
}

TEST(BeginComparison, HasTheBlocksOfTheSchedule) {
    const Comparison comparison = BeginComparison(kRegion, Schedule());
    EXPECT_EQ(comparison.region, kRegion);
    EXPECT_EQ(comparison.blocks.size(), 6u);
    EXPECT_EQ(comparison.blocks[5], (PixelRect{{103, 55}, {123, 105}}));
    EXPECT_TRUE(comparison.hasReference);
}

Comparison TwoImages() {
    Comparison comparison;
    comparison.region = {{10, 20}, {90, 60}};
    comparison.blocks = {{{10, 20}, {50, 60}}, {{50, 20}, {90, 60}}};
    comparison.cap = 100;
    comparison.hasReference = true;
    for (const char* name : {"automatic", "reference"}) {
        ComparedImage& image = comparison.images.emplace_back();
        image.name = name;
        image.image = {80, 40, std::vector<float>(80 * 40 * 3, 0.5f)};
    }
    for (int y = 0; y < 40; ++y)  // an error in the right block
        for (int x = 40; x < 80; ++x)
            comparison.images[0].image.values[size_t(3 * (y * 80 + x))] = 0.7f;
    comparison.images[0].costs = {{.spp = 20, .seconds = 2, .ruleSeconds = 1},
                                  {.spp = 50, .seconds = 10}};
    comparison.images[1].costs = {{.spp = 100, .seconds = 11}, {.spp = 100, .seconds = 25}};
    return comparison;
}

TEST(Measure, GivesFiguresByBlock) {
    Comparison comparison = TwoImages();
    Measure(&comparison);
    const ComparedImage& automatic = *comparison.Find("automatic");
    ASSERT_TRUE(automatic.figures);
    ASSERT_EQ(automatic.blockFigures.size(), 2u);
    EXPECT_EQ(automatic.blockFigures[0].rmse, 0);
    EXPECT_NEAR(automatic.blockFigures[1].rmse, 0.2 / std::sqrt(3), 1e-6);
    EXPECT_NEAR(automatic.figures->rmse, 0.2 / std::sqrt(6), 1e-6);
    EXPECT_FALSE(comparison.Find("reference")->figures);
    EXPECT_FALSE(comparison.Find("reference")->seams);  // its noise is not known
    ASSERT_TRUE(automatic.seams);
    EXPECT_GT(automatic.seams->border, 0);
    EXPECT_EQ(comparison.Find("somebody"), nullptr);
}

TEST(Measure, RefusesImagesOfOtherSizes) {
    Comparison comparison = TwoImages();
    comparison.images[0].image = {40, 80, std::vector<float>(80 * 40 * 3)};
    EXPECT_THROW(Measure(&comparison), Error);
}

TEST(SumCosts, AddsUpTheBlocks) {
    const Comparison comparison = TwoImages();
    const TotalCost cost = SumCosts(comparison, comparison.images[0]);
    EXPECT_EQ(cost.samples, 40 * 40 * 70);
    EXPECT_EQ(cost.seconds, 12);
    EXPECT_EQ(cost.ruleSeconds, 1);
}

TEST(CompareEstimates, ComparesWithWhatWasMeasured) {
    const Comparison comparison = TwoImages();
    const EstimateError error = CompareEstimates(comparison.images[0], comparison.images[1]);
    EXPECT_EQ(error.blocks, 2);
    EXPECT_DOUBLE_EQ(error.total, 30. / 36 - 1);  // 2 s * 5 and 10 s * 2
    EXPECT_DOUBLE_EQ(error.worst, 20. / 25 - 1);
}

TEST(CountVisibleBlocks, CountsThoseAboveTheThreshold) {
    Comparison comparison = BeginComparison({{0, 0}, {90, 30}}, {.blockSize = 30});
    const auto add = [&](float left, float middle) {
        ComparedImage image;
        image.image = {90, 30, {}};
        for (int i = 0; i < 90 * 30; ++i)
            for (int c = 0; c < 3; ++c)
                image.image.values.push_back(i % 90 < 30 ? left : i % 90 < 60 ? middle : 0.5f);
        comparison.images.push_back(std::move(image));
    };
    add(0.9f, 0.5f);    // plain to see
    add(0.5f, 0.501f);  // below one step of 8 bits
    add(0.5f, 0.5f);
    Measure(&comparison);
    EXPECT_GT(comparison.images[0].blockFigures[0].visibleDifference, kVisibilityThreshold);
    EXPECT_GE(CountVisibleBlocks(comparison.images[0]), 1);
    EXPECT_LT(CountVisibleBlocks(comparison.images[0]), 3);
    EXPECT_EQ(CountVisibleBlocks(comparison.images[1]), 0);
    ASSERT_EQ(comparison.images[0].visibleDifference.size(), 2700u);
    EXPECT_GT(comparison.images[0].visibleDifference[15 * 90 + 15], kVisibilityThreshold);
}

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
    options = Onto(&film, options);
    const RenderResult result = Render(options);
    const MonitoredRender monitored{options, result, histories};
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
