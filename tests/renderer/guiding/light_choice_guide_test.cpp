// Checks what is known of how much light lights bring to a place.
#include "renderer/guiding/light_choice_guide.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>

#include "tests/renderer/scene_of.h"

namespace lull::light_choice_guide_test {
namespace {

constexpr int kLights = 3;

// Three lamps of one power above a large floor.
std::unique_ptr<const Scene> MakeScene() {
    return SceneOf(WorldText(R"(
LightSource "point" "point from" [-5 0 5]
LightSource "point" "point from" [0 0 5]
LightSource "point" "point from" [5 0 5]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3]
  "point P" [-9 -9 0  9 -9 0  9 9 6  -9 9 6])"));
}

// What a lamp brings to a place: the first one to the left, the last one to the right.
float Brought(const Vec3f& p, int light) {
    return (light == 0 && p.x() < 0) || (light == 2 && p.x() >= 0) ? 0.5f : 0;
}

struct Learned {
    std::unique_ptr<const Scene> scene = MakeScene();
    LightChoiceGuide guide{scene->shapes.bounds, kLights};
    LightChoiceRecord record{guide};

    LightChoice At(const Vec3f& p, int side = 5) const {
        const std::span<const float> sums = guide.At(guide.CellOf(p, side));
        return sums.back() > 0 ? LightChoice(sums)
                               : scene->lights.Choice(p, scene->lights.PlaceOf(p));
    }
    void Record(int count, uint32_t seed) {
        std::mt19937 random(seed);
        const auto number = [&] { return float(random() >> 8) * 0x1p-24f; };
        for (int i = 0; i < count; ++i) {
            const Vec3f p(18 * number() - 9, 18 * number() - 9, 0);
            float pmf;
            const int light = At(p).Sample(number(), &pmf);
            record.Add(guide.CellOf(p, 5) + size_t(light), Brought(p, light));
        }
    }
};

TEST(LightChoiceGuide, KnowsNothingAtFirst) {
    const Learned learned;
    EXPECT_FALSE(learned.guide.IsEmpty());
    EXPECT_TRUE(IsValid(learned.guide));
    for (const float x : {-20.f, -3.f, 0.f, 8.f})
        EXPECT_EQ(learned.guide.At(learned.guide.CellOf({x, 1, 0}, kInMedium)).back(), 0);
}

TEST(LightChoiceGuide, LeadsToTheLightsThatReachAPlaceAndKeepsAPartOfTheOthers) {
    Learned learned;
    for (int round = 0; round < 3; ++round) {
        learned.Record(40000, uint32_t(round));
        learned.guide = Learn(learned.guide, learned.record, learned.scene->lights);
        EXPECT_TRUE(IsValid(learned.guide));
    }
    for (const float x : {-6.f, 6.f}) {
        const Vec3f p(x, 2, 0);
        const LightChoice choice = learned.At(p), before = learned.scene->lights.Choice(
                                                      p, learned.scene->lights.PlaceOf(p));
        EXPECT_GT(choice.Pmf(x < 0 ? 0 : 2), 0.8f);
        float sum = 0;
        for (int i = 0; i < kLights; ++i) {
            EXPECT_GT(choice.Pmf(i), 0.1f * before.Pmf(i)) << i;
            sum += choice.Pmf(i);
        }
        EXPECT_NEAR(sum, 1, 1e-6f);
        // Another side has seen nothing.
        EXPECT_EQ(learned.guide.At(learned.guide.CellOf(p, 4)).back(), 0);
    }
}

TEST(LightChoiceGuide, LearnsNothingFromDarkness) {
    Learned learned;
    for (size_t cell = 0; cell < learned.record.sums.size(); ++cell) learned.record.Add(cell, 0);
    learned.guide = Learn(learned.guide, learned.record, learned.scene->lights);
    EXPECT_EQ(std::accumulate(learned.guide.sums.begin(), learned.guide.sums.end(), 0.f), 0);
}

TEST(LightChoiceGuide, OfManyLightsHasFewerVoxels) {
    const Bounds3f cube{Vec3f(0, 0, 0), Vec3f(1, 1, 1)};
    EXPECT_EQ(LightChoiceGuide(cube, 2).grid.Count(), 4096u);
    EXPECT_EQ(LightChoiceGuide(cube, 100).grid.Count(), 512u);
}

TEST(LightChoiceGuide, DamagedTablesAreFound) {
    const Learned learned;
    for (const auto& table : {std::array{0.5f, 0.4f, 1.f}, std::array{0.2f, 0.4f, 0.9f},
                              std::array{std::nanf(""), 0.4f, 1.f}, std::array{-0.1f, 0.4f, 1.f}}) {
        LightChoiceGuide guide = learned.guide;
        std::copy(table.begin(), table.end(), guide.sums.begin() + 2 * kLights);
        EXPECT_FALSE(IsValid(guide));
    }
    LightChoiceGuide guide = learned.guide;
    guide.sums.pop_back();
    EXPECT_FALSE(IsValid(guide));
}

}  // namespace
}  // namespace lull::light_choice_guide_test
