#include "renderer/base/sampling.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull {
namespace {

using test::ChiSquarePValue;
using test::Random;

constexpr int kSamples = 200000;

// Expects the mean of f over `kSamples` uniform points to be `expected` within 4.5 standard errors.
template <typename F>
void ExpectMean(const F& f, double expected, const char* what) {
    Random random(1);
    test::SampleMean mean;
    for (int i = 0; i < kSamples; ++i) mean.Add(f(random.Point()));
    EXPECT_NEAR(mean.Value(), expected, 4.5 * mean.Error() + 1e-6) << what;
}

TEST(SineCosine, IsAsPreciseAsFloats) {
    for (int i = -1000; i <= 1000; ++i) {
        const float angle = kPi / 4 * float(i) / 1000;
        EXPECT_NEAR(SineCosineOf(angle).sine, std::sin(double(angle)), 1e-7) << angle;
        EXPECT_NEAR(SineCosineOf(angle).cosine, std::cos(double(angle)), 1e-7) << angle;
    }
    for (int i = 0; i <= 8192; ++i) {
        const float u = std::min(float(i) / 8192, kOneMinusEpsilon);
        const double angle = 2 * std::numbers::pi * double(u);
        EXPECT_NEAR(SineCosineOfTurn(u).sine, std::sin(angle), 1e-7) << u;
        EXPECT_NEAR(SineCosineOfTurn(u).cosine, std::cos(angle), 1e-7) << u;
    }
    EXPECT_EQ(SineCosineOfTurn(0).sine, 0);
    EXPECT_GT(SineCosineOfTurn(kOneMinusEpsilon / 2).sine, 0);
}

TEST(Warps, ConcentricDiskIsUniform) {
    ExpectMean([](const Vec2f& u) { return SampleConcentricDisk(u).squaredNorm(); }, 0.5, "r^2");
    ExpectMean([](const Vec2f& u) { return SampleConcentricDisk(u).x(); }, 0, "x");
    ExpectMean([](const Vec2f& u) { return SampleConcentricDisk(u).y(); }, 0, "y");
    ExpectMean([](const Vec2f& u) { return Sqr(SampleConcentricDisk(u).x()); }, 0.25, "x^2");
    ExpectMean([](const Vec2f& u) { return SampleConcentricDisk(u).prod(); }, 0, "xy");

    // Rings and sectors of equal area.
    Random random(2);
    std::vector<int64_t> cells(8 * 16);
    for (int i = 0; i < kSamples; ++i) {
        const Vec2f p = SampleConcentricDisk(random.Point());
        ASSERT_LE(p.norm(), 1 + 1e-6f);
        const double phi = std::atan2(p.y(), p.x()) / (2 * std::numbers::pi) + 0.5;
        ++cells[std::min(int(p.squaredNorm() * 8), 7) * 16 + std::min(int(phi * 16), 15)];
    }
    EXPECT_GT(ChiSquarePValue(std::vector<double>(128, 1 / 128.0), cells, kSamples), 1e-3);
    EXPECT_EQ(SampleConcentricDisk({0.5f, 0.5f}), Vec2f::Zero());
    EXPECT_NEAR(SampleConcentricDisk({0, 0}).norm(), 1, 1e-6);
}

TEST(Warps, CosineHemisphereHasItsMoments) {
    ExpectMean([](const Vec2f& u) { return SampleCosineHemisphere(u).z(); }, 2 / 3.0, "cos");
    ExpectMean([](const Vec2f& u) { return Sqr(SampleCosineHemisphere(u).z()); }, 0.5, "cos^2");
    ExpectMean([](const Vec2f& u) { return Sqr(SampleCosineHemisphere(u).x()); }, 0.25, "x^2");
    ExpectMean([](const Vec2f& u) { return SampleCosineHemisphere(u).y(); }, 0, "y");
    for (const float a : {0.f, 0.5f, kOneMinusEpsilon})
        for (const float b : {0.f, 0.5f, kOneMinusEpsilon}) {
            const Vec3f w = SampleCosineHemisphere({a, b});
            EXPECT_NEAR(w.norm(), 1, 1e-6);
            EXPECT_GE(w.z(), 0);
        }
}

TEST(Warps, SphereIsUniform) {
    for (int axis = 0; axis < 3; ++axis) {
        ExpectMean([&](const Vec2f& u) { return SampleUniformSphere(u)[axis]; }, 0, "mean");
        ExpectMean([&](const Vec2f& u) { return Sqr(SampleUniformSphere(u)[axis]); }, 1 / 3.0,
                   "second moment");
        ExpectMean([&](const Vec2f& u) { return Sqr(Sqr(SampleUniformSphere(u)[axis])); }, 0.2,
                   "fourth moment");
    }
    ExpectMean([](const Vec2f& u) { return SampleUniformSphere(u).prod(); }, 0, "xyz");
}

TEST(Warps, TriangleIsUniform) {
    ExpectMean([](const Vec2f& u) { return SampleUniformTriangle(u).x(); }, 1 / 3.0, "b0");
    ExpectMean([](const Vec2f& u) { return SampleUniformTriangle(u).y(); }, 1 / 3.0, "b1");
    ExpectMean([](const Vec2f& u) { return Sqr(SampleUniformTriangle(u).x()); }, 1 / 6.0, "b0^2");
    ExpectMean([](const Vec2f& u) { return SampleUniformTriangle(u).prod(); }, 1 / 12.0, "b0 b1");
    for (const float a : {0.f, 0.5f, kOneMinusEpsilon})
        for (const float b : {0.f, 0.5f, kOneMinusEpsilon}) {
            const Vec2f p = SampleUniformTriangle({a, b});
            EXPECT_GE(p.minCoeff(), 0);
            EXPECT_LE(p.sum(), 1);
        }
}

TEST(PowerHeuristic, WeighsBySquares) {
    EXPECT_FLOAT_EQ(PowerHeuristic(1, 1), 0.5f);
    EXPECT_FLOAT_EQ(PowerHeuristic(3, 1), 0.9f);
    EXPECT_EQ(PowerHeuristic(2, 0), 1);
    for (const float f : {1e-3f, 0.1f, 1.f, 7.f, 1e6f})
        for (const float g : {1e-3f, 0.1f, 1.f, 7.f, 1e6f})
            EXPECT_NEAR(PowerHeuristic(f, g) + PowerHeuristic(g, f), 1, 1e-6);
}

TEST(PowerHeuristic, SurvivesExtremes) {
    const float values[] = {0, 0x1p-149f, 1e-30f, 1, 1e30f, std::numeric_limits<float>::max()};
    for (const float f : values)
        for (const float g : values) {
            const float w = PowerHeuristic(f, g);
            EXPECT_TRUE(w >= 0 && w <= 1) << f << " " << g << " " << w;
        }
    EXPECT_EQ(PowerHeuristic(1, kInfinity), 0);
    EXPECT_EQ(PowerHeuristic(0, kInfinity), 0);
    EXPECT_EQ(PowerHeuristic(kInfinity, 1), 1);
    EXPECT_FLOAT_EQ(PowerHeuristic(1e30f, 1e30f), 0.5f);
}

TEST(RadicalInverse, KnowsItsValues) {
    const double base2[] = {0, 0.5, 0.25, 0.75, 0.125, 0.625, 0.375, 0.875};
    const double base3[] = {0, 1 / 3., 2 / 3., 1 / 9., 4 / 9., 7 / 9., 2 / 9., 5 / 9., 8 / 9.};
    for (int i = 0; i < 8; ++i) EXPECT_FLOAT_EQ(RadicalInverse(2, i), float(base2[i]));
    for (int i = 0; i < 9; ++i) EXPECT_FLOAT_EQ(RadicalInverse(3, i), float(base3[i]));
    EXPECT_FLOAT_EQ(RadicalInverse(11, 11 * 11 + 5), float(5 / 11. + 1 / 1331.));
    for (const int base : {2, 3, 5, 7, 11})
        for (const uint64_t index : {~0ull, ~0ull >> 1, (1ull << 32) - 1})
            EXPECT_LT(RadicalInverse(base, index), 1);
}

std::vector<std::vector<float>> Examples() {
    std::vector<std::vector<float>> examples = {
        {1}, {1, 1, 1, 1}, {0, 1, 0, 3, 0}, {1e-3f, 1, 1e-3f}, {5, 0, 0, 0, 0, 0, 0, 1}};
    std::vector<float>& ramp = examples.emplace_back();
    for (int i = 0; i < 37; ++i) ramp.push_back(float(i % 10));
    return examples;
}

TEST(Distribution1D, ChoosesByItsPmf) {
    for (const auto& values : Examples()) {
        const Distribution1D d(values);
        const int n = d.Count();
        ASSERT_EQ(n, int(values.size()));
        double total = 0, sum = 0;
        for (int i = 0; i < n; ++i) {
            total += d.Pmf(i);
            sum += values[i];
        }
        EXPECT_NEAR(total, 1, 1e-6);
        EXPECT_NEAR(d.Integral(), sum / n, 1e-6 * sum);

        Random random(3);
        std::vector<double> expected(n), density(4 * n);
        std::vector<int64_t> discrete(n), continuous(4 * n);
        for (int i = 0; i < n; ++i) expected[i] = d.Pmf(i);
        for (int i = 0; i < 4 * n; ++i) density[i] = d.Pdf((i + 0.5f) / (4 * n)) / (4 * n);
        for (int k = 0; k < kSamples; ++k) {
            float pmf, pdf;
            const int i = d.SampleDiscrete(random.Float(), &pmf);
            ASSERT_GT(pmf, 0);
            ASSERT_EQ(pmf, d.Pmf(i));
            ++discrete[i];
            int offset;
            const float x = d.SampleContinuous(random.Float(), &pdf, &offset);
            ASSERT_TRUE(x >= 0 && x < 1);
            ASSERT_GT(values[offset], 0);
            ASSERT_GT(pdf, 0);
            ++continuous[std::min(int(x * (4 * n)), 4 * n - 1)];
        }
        EXPECT_GT(ChiSquarePValue(expected, discrete, kSamples), 1e-4);
        EXPECT_GT(ChiSquarePValue(density, continuous, kSamples), 1e-4);
    }
}

TEST(Distribution1D, ReturnsThePdfOfItsSample) {
    Random random(4);
    for (const auto& values : Examples()) {
        const Distribution1D d(values);
        for (int k = 0; k < 10000; ++k) {
            float pdf;
            int offset;
            const float x = d.SampleContinuous(random.Float(), &pdf, &offset);
            // Rounding can put a sample of the last places of an element into the next one.
            if (std::abs(x * d.Count() - std::round(x * d.Count())) < 1e-5f) continue;
            ASSERT_EQ(pdf, d.Pdf(x)) << x;
        }
    }
}

TEST(Distribution1D, IsUniformWithoutWeight) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    for (const float v : {0.f, nan, kInfinity}) {
        const Distribution1D d(std::vector<float>(10, v));
        for (int i = 0; i < 10; ++i) EXPECT_NEAR(d.Pmf(i), 0.1f, 1e-7);
        EXPECT_EQ(d.Integral(), 0);
        float pdf;
        int offset;
        EXPECT_NEAR(d.SampleContinuous(0.35f, &pdf, &offset), 0.35f, 1e-6);
        EXPECT_FLOAT_EQ(pdf, 1);
        EXPECT_EQ(offset, 3);
    }
}

TEST(Distribution1D, FindsASingleSpike) {
    for (const int place : {0, 500, 999}) {
        std::vector<float> values(1000, 0);
        values[place] = 1e-20f;
        const Distribution1D d(values);
        for (const float u : {0.f, 1e-9f, 0.5f, kOneMinusEpsilon}) {
            float pmf;
            EXPECT_EQ(d.SampleDiscrete(u, &pmf), place);
            EXPECT_FLOAT_EQ(pmf, 1);
        }
    }
}

// Values so small that rounding empties their intervals must not make impossible choices.
TEST(Distribution1D, NeverChoosesZeroes) {
    std::vector<float> values;
    for (int i = 0; i < 3000; ++i) values.push_back(i % 3 == 1 ? (i % 2 ? 1e-12f : 1) : 0);
    const Distribution1D d(values);
    Random random(5);
    for (int k = 0; k < kSamples; ++k) {
        float pmf;
        const int i = d.SampleDiscrete(random.Float(), &pmf);
        ASSERT_TRUE(values[i] > 0 && pmf > 0);
    }
    float pmf;
    for (const float u : {0.f, kOneMinusEpsilon}) EXPECT_GT(values[d.SampleDiscrete(u, &pmf)], 0);
}

TEST(Distribution2D, SamplesInProportion) {
    constexpr int kNu = 12, kNv = 7;
    std::vector<float> values;
    for (int v = 0; v < kNv; ++v)
        for (int u = 0; u < kNu; ++u) values.push_back(v == 3 ? 0.f : float((u * 7 + v * 3) % 11));
    const Distribution2D d(values, kNu, kNv);
    const double sum = std::accumulate(values.begin(), values.end(), 0.0);
    std::vector<double> expected;
    for (const float value : values) expected.push_back(value / sum);
    Random random(6);
    std::vector<int64_t> cells(expected.size()), quarters(4);
    for (int k = 0; k < kSamples; ++k) {
        Vec2f place = random.Point();
        float pmf;
        const Vec2i at = d.SampleDiscrete(&place, &pmf);
        ASSERT_TRUE(place.minCoeff() >= 0 && place.maxCoeff() < 1);
        ASSERT_GT(pmf, 0);
        ASSERT_EQ(pmf, d.Pmf(at));
        ASSERT_NEAR(pmf, expected[at.y() * kNu + at.x()], 1e-5);
        ++cells[at.y() * kNu + at.x()];
        ++quarters[(place.y() >= 0.5f) * 2 + (place.x() >= 0.5f)];
    }
    EXPECT_GT(ChiSquarePValue(std::vector<double>(4, 0.25), quarters, kSamples), 1e-3);
    EXPECT_GT(ChiSquarePValue(expected, cells, kSamples), 1e-3);
}

TEST(Distribution2D, FindsSpikes) {
    std::vector<float> values(100 * 50, 0);
    values[20 * 100 + 30] = 1e6f;
    const Distribution2D spike(values, 100, 50);
    Random random(7);
    for (int k = 0; k < 1000; ++k) {
        Vec2f place = random.Point();
        float pmf;
        EXPECT_EQ(spike.SampleDiscrete(&place, &pmf), Vec2i(30, 20));
        EXPECT_EQ(pmf, 1);
    }
}

}  // namespace
}  // namespace lull
