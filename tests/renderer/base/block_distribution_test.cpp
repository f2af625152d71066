#include "renderer/base/sampling.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull::block_distribution_test {
namespace {

using test::ChiSquarePValue;
using test::Random;

// Weights of which no block is even, some cells of which are black, with a spike; neither side is a
// multiple of the blocks'.
constexpr int kColumns = 53, kRows = 37;
float Uneven(int column, int row) {
    if (row == 20 || (column >= 16 && column < 32 && row < 16)) return 0;
    return float((column * 7 + row * 3) % 11) + (column == 40 && row == 5) * 3000.f;
}

// Weights that change slowly, with a spike.
float Slow(int column, int row) {
    return 10 + 0.05f * float(column + row) + (column == 18 && row == 33) * 500.f;
}

BlockDistribution Make(float (*weight)(int, int), float tolerance) {
    return {kColumns, kRows,
            [weight](int row, std::span<float> weights) {
                for (int column = 0; column < int(weights.size()); ++column)
                    weights[column] = weight(column, row);
            },
            tolerance};
}

// Returns the density's integral over each cell.
std::vector<double> MassesOf(const BlockDistribution& d) {
    std::vector<double> masses;
    for (int v = 0; v < kRows; ++v)
        for (int u = 0; u < kColumns; ++u)
            masses.push_back(d.Pdf({(u + 0.5f) / kColumns, (v + 0.5f) / kRows}) /
                             (kColumns * kRows));
    return masses;
}

std::vector<double> Proportional(float (*weight)(int, int)) {
    std::vector<double> shares;
    for (int v = 0; v < kRows; ++v)
        for (int u = 0; u < kColumns; ++u) shares.push_back(weight(u, v));
    const double sum = std::accumulate(shares.begin(), shares.end(), 0.0);
    for (double& share : shares) share /= sum;
    return shares;
}

TEST(BlockDistribution, IsExactWithoutTolerance) {
    for (const auto weight : {Uneven, Slow}) {
        const auto masses = MassesOf(Make(weight, 0)), expected = Proportional(weight);
        for (size_t i = 0; i < masses.size(); ++i)
            EXPECT_NEAR(masses[i], expected[i], 1e-6 + 1e-4 * expected[i]);
    }
}

TEST(BlockDistribution, SamplesHaveTheDensityThatTheyKnow) {
    for (const auto weight : {Uneven, Slow})
        for (const float tolerance : {0.f, 0.01f, 10.f}) {
            const BlockDistribution d = Make(weight, tolerance);
            const auto masses = MassesOf(d);
            EXPECT_NEAR(std::accumulate(masses.begin(), masses.end(), 0.0), 1, 1e-5);
            constexpr int kSamples = 400000;
            Random random(1);
            std::vector<int64_t> cells(masses.size()), quarters(4);
            for (int k = 0; k < kSamples; ++k) {
                float pdf;
                const Vec2f st = d.Sample(random.Point(), &pdf);
                ASSERT_TRUE(st.minCoeff() >= 0 && st.maxCoeff() < 1);
                ASSERT_GT(pdf, 0);
                const float x = st.x() * kColumns, y = st.y() * kRows;
                ++cells[int(y) * kColumns + int(x)];
                ++quarters[(y - std::floor(y) >= 0.5f) * 2 + (x - std::floor(x) >= 0.5f)];
                // Rounding can put a sample of the last places of a cell into the next one.
                if (std::min(std::abs(x - std::round(x)), std::abs(y - std::round(y))) < 1e-4f)
                    continue;
                ASSERT_FLOAT_EQ(pdf, d.Pdf(st));
            }
            EXPECT_GT(ChiSquarePValue(masses, cells, kSamples), 1e-3);
            EXPECT_GT(ChiSquarePValue(std::vector<double>(4, 0.25), quarters, kSamples), 1e-3);
        }
}

// What blocks without tables may cost is the tolerance, and cells with weight are never left out.
TEST(BlockDistribution, KeepsToTheTolerance) {
    for (const auto weight : {Uneven, Slow}) {
        const auto shares = Proportional(weight);
        double last = 0;
        for (const float tolerance : {0.f, 1e-4f, 0.01f, 0.1f, 0.3f}) {
            const auto masses = MassesOf(Make(weight, tolerance));
            double variance = -1;
            for (size_t i = 0; i < shares.size(); ++i) {
                if (shares[i] == 0) continue;
                ASSERT_GT(masses[i], 0);
                variance += shares[i] * shares[i] / masses[i];
            }
            EXPECT_LT(variance, tolerance + 1e-5) << tolerance;
            EXPECT_GE(variance, last - 1e-5);
            last = variance;
        }
        EXPECT_GT(last, 1e-4);  // some are left out
    }
}

TEST(BlockDistribution, HoldsExtremes) {
    float pdf;
    const BlockDistribution none = Make([](int, int) { return 0.f; }, 0.01f);
    const Vec2f st = none.Sample({0.3f, kOneMinusEpsilon}, &pdf);
    EXPECT_TRUE(st.minCoeff() >= 0 && st.maxCoeff() < 1);
    EXPECT_EQ(pdf, 0);
    EXPECT_EQ(none.Pdf(st), 0);

    for (const auto spike : {+[](int u, int v) { return u == 52 && v == 36 ? 1e37f : 0.f; },
                             +[](int u, int v) { return u == 52 && v == 36 ? 1e-40f : 0.f; }}) {
        const BlockDistribution d = Make(spike, 0.01f);
        for (const float a : {0.f, 0.5f, kOneMinusEpsilon})
            for (const float b : {0.f, 0.5f, kOneMinusEpsilon}) {
                const Vec2f at = d.Sample({a, b}, &pdf);
                EXPECT_NEAR(at.x(), 52.5 / kColumns, 0.50001 / kColumns);
                EXPECT_NEAR(at.y(), 36.5 / kRows, 0.50001 / kRows);
                EXPECT_FLOAT_EQ(pdf, kColumns * kRows);
            }
    }
    const BlockDistribution one(
        1, 1, [](int, std::span<float> w) { w[0] = 3; }, 0);
    EXPECT_FLOAT_EQ(one.Pdf({0.2f, 0.9f}), 1);
}

}  // namespace
}  // namespace lull::block_distribution_test
