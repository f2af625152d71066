#include "renderer/render/graded_criterion.h"

#include <gtest/gtest.h>

#include "stopping/base/state.h"

namespace lull {
namespace {

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
