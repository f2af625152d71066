#include "renderer/render/block_monitor.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "stopping/base/state.h"
#include "stopping/rules/baselines.h"

namespace lull {
namespace {

constexpr int kSide = 40;

// Shows a block whose noise falls with the samples.
struct FadingBlock {
    std::vector<float> mean, halfMean;

    BlockView At(int spp) {
        std::mt19937 random(unsigned(spp) + 1u);
        std::normal_distribution<float> normal(0.f, 0.5f / std::sqrt(float(spp)));
        mean.clear();
        halfMean.clear();
        for (int i = 0; i < 3 * kSide * kSide; ++i) {
            mean.push_back(0.4f + normal(random));
            halfMean.push_back(mean.back() + normal(random));
        }
        BlockView view;
        view.width = view.height = kSide;
        view.spp = spp;
        view.mean = mean;
        view.halfMean = halfMean;
        view.seconds = 0.5 * spp;
        view.viewSeconds = 0.25;
        return view;
    }
};

std::vector<std::unique_ptr<Criterion>> FixedRules(std::initializer_list<int> spp) {
    std::vector<std::unique_ptr<Criterion>> rules;
    for (const int n : spp) rules.push_back(n > 0 ? MakeCriterion(FixedRule(n)) : nullptr);
    return rules;
}

TEST(BlockMonitor, KeepsTheBlockWhereRulesStopIt) {
    FadingBlock block;
    BlockHistory history;
    BlockMonitor monitor(FixedRules({40, 80, 40}), {.snapshots = true, .goesOn = true}, &history);
    std::vector<float> at40, at80;
    for (int spp = 20; spp <= 120; spp += 20) {
        const BlockView view = block.At(spp);
        EXPECT_NE(monitor.Need(spp), ViewNeed::Nothing);
        EXPECT_FALSE(monitor.Observe(view).stop);
        if (spp == 40) at40 = block.mean;
        if (spp == 80) at80 = block.mean;
    }
    ASSERT_EQ(history.stops.size(), 3u);
    EXPECT_EQ(history.stops[0].spp, 40);
    EXPECT_EQ(history.stops[1].spp, 80);
    EXPECT_EQ(history.stops[2].spp, 40);
    EXPECT_EQ(history.stops[1].seconds, 40);
    ASSERT_EQ(history.snapshots.size(), 2u);
    EXPECT_EQ(history.snapshots[40].mean, at40);
    EXPECT_EQ(history.snapshots[80].mean, at80);
    EXPECT_TRUE(history.snapshots[40].noise.empty());
}

TEST(BlockMonitor, StopsWithTheLastRule) {
    FadingBlock block;
    BlockHistory history;
    BlockMonitor monitor(FixedRules({60, 0, 40}), {}, &history);
    EXPECT_EQ(monitor.Need(20), ViewNeed::Nothing);
    EXPECT_FALSE(monitor.Observe(block.At(20)).stop);
    EXPECT_FALSE(monitor.Observe(block.At(40)).stop);
    EXPECT_TRUE(monitor.Observe(block.At(60)).stop);
    EXPECT_TRUE(history.snapshots.empty());
    EXPECT_TRUE(history.curves.spp.empty());
}

TEST(BlockMonitor, PassesOnWhatTheFirstRuleSays) {
    FadingBlock block;
    BlockHistory history;
    std::vector<std::unique_ptr<Criterion>> rules;
    rules.push_back(MakeCriterion(DammertzRule(0.05)));
    rules.push_back(MakeCriterion(FixedRule(2000)));
    BlockMonitor monitor(std::move(rules), {.goesOn = true}, &history);
    const std::unique_ptr<Criterion> alone = MakeCriterion(DammertzRule(0.05));
    bool stopped = false;
    for (int spp = 20; spp <= 2000; spp += 20) {
        const BlockView view = block.At(spp);
        const Decision seen = monitor.Observe(view);
        if (stopped) {
            EXPECT_FALSE(seen.checked);
            continue;
        }
        const Decision expected = alone->Observe(view);
        EXPECT_EQ(seen.value, expected.value);
        EXPECT_EQ(seen.checked, expected.checked);
        stopped = expected.stop;
        if (stopped) {
            EXPECT_EQ(history.stops[0].spp, spp);
        }
    }
    EXPECT_TRUE(stopped);
    // The cost of the view is counted for the rule that looks at it.
    EXPECT_GE(history.stops[0].ruleSeconds, 0.25 * history.stops[0].spp / 20);
    EXPECT_LT(history.stops[1].ruleSeconds, 0.25);
}

TEST(BlockMonitor, RecordsCurvesThatFall) {
    FadingBlock block;
    BlockHistory history;
    BlockMonitor monitor(FixedRules({4000}), {.curves = true}, &history);
    for (int spp = 20; spp <= 4000; spp += 20) monitor.Observe(block.At(spp));
    const BlockCurves& curves = history.curves;
    ASSERT_GT(curves.spp.size(), 20u);
    EXPECT_LT(curves.spp.size(), 60u);
    EXPECT_EQ(curves.spp.front(), 20);
    EXPECT_LT(curves.noise.back(), 0.2f * curves.noise.front());
    EXPECT_LT(curves.entropy.back(), curves.entropy.front());
}

TEST(BlockMonitor, GoesOnAfterAnInterruption) {
    FadingBlock block;
    const MonitorOptions options{.snapshots = true, .noise = true, .curves = true, .goesOn = true};
    const auto rules = [] {
        auto made = FixedRules({40, 0});
        made.push_back(MakeCriterion(CyclesRule(0.05)));
        return made;
    };
    BlockHistory whole, parts;
    BlockMonitor undisturbed(rules(), options, &whole);
    auto interrupted = std::make_unique<BlockMonitor>(rules(), options, &parts);
    for (int spp = 20; spp <= 3000; spp += 20) {
        const BlockView view = block.At(spp);
        undisturbed.Observe(view);
        interrupted->Observe(view);
        if (spp % 300 != 0) continue;
        const std::vector<std::byte> state = interrupted->Save();
        interrupted = std::make_unique<BlockMonitor>(rules(), options, &parts);
        interrupted->Restore(state);
    }
    for (size_t i = 0; i < 3; ++i) EXPECT_EQ(parts.stops[i].spp, whole.stops[i].spp);
    EXPECT_GT(whole.stops[2].spp, 0);
    ASSERT_EQ(parts.snapshots.size(), whole.snapshots.size());
    for (const auto& [spp, snapshot] : whole.snapshots) {
        EXPECT_EQ(parts.snapshots.at(spp).mean, snapshot.mean);
        EXPECT_EQ(parts.snapshots.at(spp).noise, snapshot.noise);
    }
    EXPECT_EQ(parts.curves.spp, whole.curves.spp);
    EXPECT_EQ(parts.curves.noise, whole.curves.noise);
}

TEST(BlockMonitor, RefusesStatesThatAreNotItsOwn) {
    FadingBlock block;
    BlockHistory history, other;
    BlockMonitor monitor(FixedRules({40}), {.snapshots = true}, &history);
    monitor.Observe(block.At(20));
    monitor.Observe(block.At(40));
    std::vector<std::byte> state = monitor.Save();
    BlockMonitor two(FixedRules({40, 60}), {.snapshots = true}, &other);
    EXPECT_THROW(two.Restore(state), std::runtime_error);
    for (const size_t size : {size_t(0), size_t(3), size_t(30), state.size() - 1}) {
        BlockMonitor fresh(FixedRules({40}), {.snapshots = true}, &other);
        EXPECT_THROW(fresh.Restore(std::span(state).first(size)), std::runtime_error) << size;
    }
}

// Stops a block of one pixel once its red over spp is below 1, and keeps
// the number of its checks.
struct Probe final : Criterion {
    ViewNeed Need(int) const override { return ViewNeed::MeanAndHalf; }
    Decision Observe(const BlockView& view) override {
        ++checks;
        const double value = view.mean[0] / view.spp;
        return {.stop = value < 1, .checked = true, .value = value, .threshold = 1};
    }
    std::optional<double> NetworkNoise() const override { return checks; }
    std::vector<std::byte> Save() const override {
        StateWriter writer;
        writer.Put(checks);
        return std::move(writer.bytes);
    }
    void Restore(std::span<const std::byte> state) override {
        StateReader reader(state);
        checks = reader.Get<int>();
    }
    int checks = 0;
};

GradedCriterion MakeGraded() {
    std::vector<GradedJudge> judges;
    judges.push_back({{}, std::make_unique<Probe>()});
    judges.push_back({{.exposure = 2}, std::make_unique<Probe>()});
    return GradedCriterion(std::move(judges));
}

Decision Observe(Criterion* criterion, int spp) {
    const std::vector<float> mean = {10, 10, 10}, half = {12, 10, 10};
    return criterion->Observe({1, 1, spp, mean, half});
}

// 10 / spp is below 1 from 11 on, four times as much from 41 on.
TEST(GradedCriterion, StopsWhereTheNoisiestPictureDoes) {
    GradedCriterion graded = MakeGraded();
    EXPECT_EQ(graded.Need(20), ViewNeed::MeanAndHalf);
    EXPECT_EQ(Observe(&graded, 10).value, 4);
    const Decision between = Observe(&graded, 20);
    EXPECT_FALSE(between.stop);
    EXPECT_EQ(between.value, 2);
    EXPECT_FALSE(Observe(&graded, 40).stop);
    const Decision end = Observe(&graded, 50);
    EXPECT_TRUE(end.stop);
    EXPECT_FLOAT_EQ(float(end.value), 0.8f);
    EXPECT_EQ(graded.NetworkNoise(), 4);
}

TEST(GradedCriterion, GoesOnFromWhatItHasSaved) {
    GradedCriterion graded = MakeGraded(), restored = MakeGraded();
    Observe(&graded, 10);
    Observe(&graded, 20);
    restored.Restore(graded.Save());
    EXPECT_FALSE(Observe(&restored, 40).stop);
    EXPECT_EQ(restored.NetworkNoise(), 3);
    EXPECT_TRUE(Observe(&restored, 50).stop);
    const std::vector<std::byte> damaged(7);
    EXPECT_THROW(MakeGraded().Restore(damaged), std::runtime_error);
}

// Keeps the pixels that it was shown.
struct Spy final : Criterion {
    explicit Spy(std::vector<float>* to) : to(to) {}
    ViewNeed Need(int) const override { return ViewNeed::MeanAndHalf; }
    Decision Observe(const BlockView& view) override {
        to->assign(view.mean.begin(), view.mean.end());
        to->insert(to->end(), view.halfMean.begin(), view.halfMean.end());
        return {};
    }
    std::vector<float>* to;
};

TEST(GradedCriterion, ShowsBothHalvesGraded) {
    std::vector<float> shown;
    std::vector<GradedJudge> judges;
    judges.push_back({{.toneMap = ToneMap::Filmic}, std::make_unique<Spy>(&shown)});
    GradedCriterion graded(std::move(judges));
    Observe(&graded, 20);
    ASSERT_EQ(shown.size(), 6u);
    EXPECT_FLOAT_EQ(shown[0], FilmicToneMap(10));
    EXPECT_NEAR(shown[3] - shown[0], (FilmicToneMap(12) - FilmicToneMap(8)) / 2, 1e-6f);
    EXPECT_EQ(shown[4], shown[1]);
}

}  // namespace
}  // namespace lull
