// Checks what is known of where light comes from: how it is recorded, refined and sampled.
#include "renderer/guiding/guide.h"

#include <gtest/gtest.h>

#include <random>
#include <thread>

#include "renderer/base/sampling.h"
#include "renderer/guiding/guide_refine.h"

namespace lull {
namespace {

const Bounds3f kBounds{Vec3f(-1, -2, -3), Vec3f(4, 3, 2)};

GuideState MakeState(int depth = 3, int quadDepth = 2) {
    GuideState state{Guide(kBounds, depth, quadDepth), {}};
    state.record = GuideRecord(state.guide);
    return state;
}

float Number(std::mt19937* random) { return float((*random)() >> 8) * 0x1p-24f; }

// Makes a vertex that has found a lobe of light around an axis, from a uniform choice of
// directions. Its leaf is for who records it to fill in.
GuideVertex MakeVertex(std::mt19937* random, const Vec3f& axis, float sharpness) {
    GuideVertex v{};
    for (int i = 0; i < 3; ++i)
        v.p[i] = kBounds.lower[i] + (kBounds.upper[i] - kBounds.lower[i]) * Number(random);
    v.w = SampleUniformSphere({Number(random), Number(random)});
    v.pdf = v.bsdfPdf = v.guidePdf = 0.25f * kInvPi;
    v.found = std::exp(sharpness * (v.w.dot(axis) - 1));
    return v;
}

void Add(GuideState* state, GuideVertex v) {
    v.leaf = state->guide.Find(v.p);
    state->record.Add(state->guide, v);
}

// Learns the lobe in a few rounds.
Guide LearnLobe(uint32_t seed, const Vec3f& axis, float sharpness) {
    std::mt19937 random(seed);
    GuideState state = MakeState();
    const RefineOptions options{.leafVertices = 2000, .knowsFractions = false};
    for (int round = 0; round < 3; ++round) {
        for (int i = 0; i < 8000 << round; ++i) Add(&state, MakeVertex(&random, axis, sharpness));
        if (round < 2) state = Refine(state, options);
    }
    return FreezeGuide(state, options);
}

TEST(Guide, DirectionsFillTheSquareEvenly) {
    std::mt19937 random(1);
    for (int i = 0; i < 10000; ++i) {
        const Vec2f s(Number(&random), Number(&random));
        const Vec3f w = DirectionFromSquare(s);
        EXPECT_NEAR(w.norm(), 1, 1e-5);
        const Vec2f back = SquareFromDirection(w);
        EXPECT_NEAR(back.x(), s.x(), 1e-5);
        // Near the poles the angle is hardly known.
        if (w.head<2>().norm() > 0.01f) {
            EXPECT_NEAR(std::remainder(back.y() - s.y(), 1.f), 0, 1e-4);
        }
    }
    for (const Vec3f& w : {Vec3f(0, 0, 1), Vec3f(0, 0, -1), Vec3f(-1, 0, 0), Vec3f(-1, -0.f, 0)}) {
        const Vec2f s = SquareFromDirection(w);
        EXPECT_TRUE((s.array() >= 0).all() && (s.array() < 1).all()) << w.transpose();
    }
}

// Chi-square: directions fall into cells of the square as often as the density there says.
TEST(Guide, SamplingHasTheDensityItStates) {
    constexpr int kCells = 12, kFine = 24, kSamples = 20000;
    std::mt19937 random(7);
    for (uint32_t seed = 0; seed < 20; ++seed) {
        const Vec3f axis = SampleUniformSphere({Number(&random), Number(&random)});
        const Guide guide = LearnLobe(seed, axis, float(1 << (seed % 6)));
        const GuideLeaf& leaf = guide.Leaf(guide.Find({0.5f, 0.5f, 0.5f}));
        ASSERT_GT(leaf.nodeCount, 1u);
        std::vector<double> expected(kCells * kCells), found(expected.size());
        double total = 0;
        for (int y = 0; y < kCells * kFine; ++y)
            for (int x = 0; x < kCells * kFine; ++x) {
                const Vec2f s((float(x) + 0.5f) / (kCells * kFine),
                              (float(y) + 0.5f) / (kCells * kFine));
                const double density =
                    double(guide.Pdf(leaf, DirectionFromSquare(s))) * 4 * std::numbers::pi;
                expected[size_t(y / kFine * kCells + x / kFine)] += density;
                total += density;
            }
        EXPECT_NEAR(total / Sqr(kCells * kFine), 1, 0.02) << seed;  // midpoints across borders
        for (int i = 0; i < kSamples; ++i) {
            float pdf;
            const Vec3f w = guide.Sample(leaf, {Number(&random), Number(&random)}, &pdf);
            ASSERT_GT(pdf, 0);
            ASSERT_NEAR(w.norm(), 1, 1e-5);
            const Vec2f s = SquareFromDirection(w);
            ++found[size_t(int(s.y() * kCells) * kCells + int(s.x() * kCells))];
        }
        double chi2 = 0;
        int cells = 0;
        for (size_t i = 0; i < found.size(); ++i) {
            const double mean = expected[i] / total * kSamples;
            if (mean < 5) continue;
            // The expected count has an error of its own, of cells that borders cut.
            chi2 += Sqr(found[i] - mean) / (mean + Sqr(0.02 * mean));
            ++cells;
        }
        const double degrees = cells - 1;
        EXPECT_LT(chi2, degrees + 5 * std::sqrt(2 * degrees) + 5) << seed;
    }
}

TEST(Guide, SampledDensityIsThatOfTheDirection) {
    const Guide guide = LearnLobe(3, Vec3f(0.6f, 0, 0.8f), 20);
    std::mt19937 random(5);
    int differ = 0;
    for (int i = 0; i < 10000; ++i) {
        const GuideLeaf& leaf = guide.Leaf(uint32_t(i) % uint32_t(guide.leaves.size()));
        float pdf;
        const Vec3f w = guide.Sample(leaf, {Number(&random), Number(&random)}, &pdf);
        differ += std::abs(guide.Pdf(leaf, w) / pdf - 1) > 1e-4f;  // rounding across a border
    }
    EXPECT_LE(differ, 10);
}

TEST(Guide, LearnsWhereLightIs) {
    const Vec3f axis(0, 0.6f, 0.8f);
    const Guide guide = LearnLobe(11, axis, 50);
    const GuideLeaf& leaf = guide.Leaf(guide.Find({0, 0, 0}));
    const float uniform = 0.25f * kInvPi;
    EXPECT_GT(guide.Pdf(leaf, axis), 15 * uniform);  // of 50 times at the peak
    EXPECT_LT(guide.Pdf(leaf, -axis), 0.1f * uniform);
}

TEST(Guide, PlacesFindTheirLeaf) {
    const Guide guide = LearnLobe(2, Vec3f::UnitX(), 4);
    EXPECT_GT(guide.leaves.size(), 8u);  // more than there were at first
    std::vector<int> visits(guide.leaves.size());
    std::mt19937 random(9);
    for (int i = 0; i < 100000; ++i) ++visits[guide.Find(MakeVertex(&random, Vec3f::UnitX(), 1).p)];
    const auto [least, most] = std::minmax_element(visits.begin(), visits.end());
    EXPECT_GT(*least, 0);
    EXPECT_LT(*most, 100000 / 8);
    // Anything has a leaf.
    for (const float x : {-1e30f, 1e30f, kInfinity, -kInfinity, std::nanf("")})
        EXPECT_LT(guide.Find({x, 0, x}), guide.leaves.size());
}

TEST(Guide, FitsTheMemoryItIsGiven) {
    std::mt19937 random(4);
    GuideState state = MakeState();
    constexpr size_t kBytes = 100'000;
    const RefineOptions options{.leafVertices = 50, .quadrantShare = 5e-3f, .maxBytes = kBytes};
    for (int round = 0; round < 4; ++round) {
        for (int i = 0; i < 20000; ++i) Add(&state, MakeVertex(&random, Vec3f::UnitZ(), 30));
        state = Refine(state, options);
        EXPECT_LE(state.guide.Bytes() + state.record.Bytes(), kBytes);
    }
    EXPECT_GT(state.guide.leaves.size(), 8u);
}

TEST(Guide, WithstandsAnyNumber) {
    std::mt19937 random(6);
    GuideState state = MakeState();
    const float numbers[] = {0, -1, 1e-38f, 1e-20f, 1, 1e30f, kInfinity, -kInfinity, std::nanf("")};
    for (int i = 0; i < 20000; ++i) {
        GuideVertex v = MakeVertex(&random, Vec3f::UnitZ(), 3);
        const auto pick = [&] { return numbers[random() % std::size(numbers)]; };
        if (i % 2) v.found = pick();
        if (i % 3 == 0) v.pdf = pick();
        if (i % 5 == 0) v.bsdfPdf = pick();
        if (i % 7 == 0) v.guidePdf = pick();
        if (i % 11 == 0) v.p.x() = pick();
        Add(&state, v);
    }
    state = Refine(state, {});
    const Guide guide = FreezeGuide(state, {});
    for (const GuideLeaf& leaf : guide.leaves) {
        EXPECT_TRUE(leaf.fraction >= 0 && leaf.fraction < 1);
        for (int i = 0; i < 100; ++i) {
            float pdf;
            const Vec3f w = guide.Sample(leaf, {Number(&random), Number(&random)}, &pdf);
            EXPECT_TRUE(w.allFinite() && pdf > 0 && pdf < kInfinity);
        }
    }
}

// One firefly must not make everything else dark.
TEST(Guide, FirefliesAreBounded) {
    std::mt19937 random(8);
    GuideState state = MakeState(0, 3);
    for (int i = 0; i < 200'000; ++i) {
        GuideVertex v = MakeVertex(&random, Vec3f::UnitX(), 2);
        if (i == 1000) v.found = 1e30f;
        Add(&state, v);
    }
    const Guide guide = FreezeGuide(state, {});
    EXPECT_GT(guide.Pdf(guide.Leaf(0), Vec3f::UnitX()), 0.5f * 0.25f * kInvPi);
}

TEST(Guide, SumsDoNotDependOnTheOrder) {
    std::mt19937 random(12);
    std::vector<GuideVertex> vertices;
    for (int i = 0; i < 20000; ++i) vertices.push_back(MakeVertex(&random, Vec3f::UnitY(), 5));
    GuideState one = MakeState(), many = MakeState();
    for (GuideVertex& v : vertices) v.leaf = one.guide.Find(v.p);
    for (const GuideVertex& v : vertices) one.record.Add(one.guide, v);
    {
        std::vector<std::jthread> threads;
        for (size_t t = 0; t < 4; ++t)
            threads.emplace_back([&, t] {
                for (size_t i = vertices.size(); i-- > 0;)
                    if (i % 4 == t) many.record.Add(many.guide, vertices[i]);
            });
    }
    EXPECT_EQ(one.record.sums, many.record.sums);
    for (size_t i = 0; i < one.record.leaves.size(); ++i) {
        EXPECT_EQ(one.record.leaves[i].vertices, many.record.leaves[i].vertices);
        EXPECT_EQ(one.record.leaves[i].cost, many.record.leaves[i].cost);
    }
}

// Where the guide knows better than the BSDF it is used more.
TEST(Guide, FractionSuitsWhatThePartsAreWorth) {
    const auto learned = [](float bsdfPdf, float guidePdf) {
        GuideState state = MakeState(0, 1);
        for (int i = 0; i < 1000; ++i)
            state.record.Add(state.guide, {.p = Vec3f::Zero(),
                                           .w = Vec3f::UnitZ(),
                                           .leaf = 0,
                                           .pdf = 1,
                                           .bsdfPdf = bsdfPdf,
                                           .guidePdf = guidePdf,
                                           .found = 1});
        return FreezeGuide(state, {}).Leaf(0).fraction;
    };
    EXPECT_EQ(learned(1, 0.1f), 0);
    EXPECT_EQ(learned(0.1f, 1), GuideRecord::kFractions.back());
}

}  // namespace
}  // namespace lull
