// Checks what is known of which tiles of the environment light a place.
#include "renderer/guiding/environment_guide.h"

#include <gtest/gtest.h>

#include <random>
#include <thread>

namespace lull::environment_guide_test {
namespace {

const Bounds3f kBounds{Vec3f(-1, -1, -1), Vec3f(1, 1, 1)};
constexpr int kTiles = TileShares::kCount;

float Number(std::mt19937* random) { return float((*random)() >> 8) * 0x1p-24f; }

TileShares Even() { return TileShares(std::vector<float>(kTiles, 1.f)); }

EnvironmentState Begin(const TileShares& shares, int depth = 2) {
    EnvironmentState state{EnvironmentGuide(kBounds, depth, shares), {}};
    state.record = EnvironmentRecord(state.guide);
    return state;
}

// Tells which tile lights a place: one on the left, another on the right.
int TileThatLights(const Vec3f& p) { return p.x() < 0 ? 40 : 100; }

// Samples tiles on one side as the guide says, at even places, and records what they bring.
void Record(int count, uint32_t seed, EnvironmentState* state) {
    std::mt19937 random(seed);
    for (int i = 0; i < count; ++i) {
        const Vec3f p(2 * Number(&random) - 1, 2 * Number(&random) - 1, 2 * Number(&random) - 1);
        const TileShares& leaf = state->guide.Find(p, 3);
        Vec2f u(Number(&random), Number(&random));
        const int tile = leaf.Choose(&u);
        state->record.Add(state->guide.NumberOf(&leaf), tile, tile == TileThatLights(p) ? 1.f : 0);
    }
}

TEST(EnvironmentGuide, KnowsSidesByTheAxisTheyFace) {
    EXPECT_EQ(SideOf({-1, 0.1f, 0}), 0);
    EXPECT_EQ(SideOf({0.9f, -0.1f, 0}), 1);
    EXPECT_EQ(SideOf({0.1f, 0.2f, -0.3f}), 4);
    EXPECT_EQ(SideOf({0.1f, 0.2f, 0.3f}), 5);
}

TEST(EnvironmentGuide, BeginsWithSamplingByPower) {
    const EnvironmentState state = Begin(Even(), 3);
    for (const float x : {-5.f, -0.4f, 0.f, 0.7f, 9.f})
        for (int side = 0; side < kSides; ++side)
            EXPECT_EQ(state.guide.Find({x, 0.1f, -x}, side).bands, Even().bands);
}

TEST(EnvironmentGuide, LeadsToTheTilesThatLightAPlaceAndKeepsAPartOfTheOthers) {
    EnvironmentState state = Begin(Even());
    for (int round = 0; round < 4; ++round) {
        Record(20000 << round, uint32_t(round), &state);
        state = Refine(state, Even(), {});
    }
    for (const float x : {-0.6f, 0.6f}) {
        const Vec3f p(x, 0.3f, -0.2f);
        const TileShares& leaf = state.guide.Find(p, 3);
        EXPECT_TRUE(IsValid(leaf));
        EXPECT_GT(leaf.Probability(TileThatLights(p)), 0.3f);
        for (int tile = 0; tile < kTiles; ++tile)
            EXPECT_GT(leaf.Probability(tile), 0.1f / kTiles) << tile;
        // Other sides have seen nothing.
        EXPECT_NEAR(state.guide.Find(p, 2).Probability(TileThatLights(p)), 1.f / kTiles, 1e-3);
    }
}

// With a sun that is nearly all of the power and was never seen, what comes late is bounded.
TEST(EnvironmentGuide, NeverSeenTilesKeepAPartOfTheirPower) {
    std::vector<float> weights(kTiles, 1e-4f);
    weights[77] = 1;
    const TileShares shares(weights);
    EnvironmentState state = Begin(shares);
    for (int round = 0; round < 5; ++round) {
        Record(50000, uint32_t(round), &state);
        state = Refine(state, shares, {});
        for (const TileShares& leaf : state.guide.leaves)
            EXPECT_GT(leaf.Probability(77), 0.1f * shares.Probability(77));
    }
}

TEST(EnvironmentGuide, IsTheSameInAnyOrderAndKeepsToItsLeaves) {
    EnvironmentState one = Begin(Even()), other = Begin(Even());
    Record(30000, 1, &one);
    Record(30000, 2, &one);
    {
        const std::jthread thread([&] { Record(30000, 2, &other); });
        Record(30000, 1, &other);
    }
    EXPECT_TRUE(one.record.sums == other.record.sums);
    const EnvironmentState fine = Refine(one, Even(), {.leafSamples = 100, .mostLeaves = 500});
    EXPECT_LE(fine.guide.leaves.size(), 500u);
    EXPECT_GT(fine.guide.leaves.size(), one.guide.leaves.size());
    EXPECT_EQ(fine.record.sums.size(), fine.guide.leaves.size() * kTiles);
    for (const SpaceTree& tree : fine.guide.trees)
        EXPECT_TRUE(tree.IsValid(fine.guide.leaves.size()));
}

TEST(EnvironmentRecord, CountsWhatIsNoLightAsNone) {
    EnvironmentState state = Begin(Even());
    for (const float brought : {std::nanf(""), -1.f, 0.f, 2.f, kInfinity})
        state.record.Add(1, 5, brought);
    EXPECT_EQ(state.record.sums[kTiles + 5].count, 5u);
    EXPECT_EQ(state.record.sums[kTiles + 5].squares,
              uint64_t((4 + EnvironmentRecord::kLargest) * SquareSum::kScale));
}

}  // namespace
}  // namespace lull::environment_guide_test
