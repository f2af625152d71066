#include "stopping/signals/svd_entropy.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "stopping/signals/lightness.h"
#include "tests/shared_folder.h"
#include "tests/stopping/golden_data.h"
#include "tests/stopping/read_png.h"

namespace lull {
namespace {

using RowMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

// Computes the lightness of a block of an 8-bit image.
std::vector<double> BlockOf(const std::vector<uint8_t>& srgb, int imageWidth, int x0, int y0,
                            int size) {
    std::vector<uint8_t> block;
    for (int y = y0; y < y0 + size; ++y) {
        const auto row = srgb.begin() + 3 * (y * imageWidth + x0);
        block.insert(block.end(), row, row + 3 * size);
    }
    std::vector<double> lightness(size_t(size * size));
    Lightness(block, lightness);
    return lightness;
}

TEST(SvdEntropy, AgreesOnARealImage) {
    LULL_SHARED_FILE(imagePath, "golden/bathroom_00010.png");
    const nlohmann::json golden = ReadJson(GoldenFile("svd_entropy_bathroom.json"));
    const int width = 800;
    const std::vector<uint8_t> srgb = ReadPng(imagePath.string(), width, 800);
    ASSERT_EQ(srgb.size(), size_t(width) * 800 * 3);

    double worstMean = 0, worstEntropy = 0;
    for (size_t block = 0; block < 16; ++block) {
        const std::vector<double> lightness =
            BlockOf(srgb, width, int(block) % 4 * 200, int(block) / 4 * 200, 200);
        const double mean = std::accumulate(lightness.begin(), lightness.end(), 0.0) / 40000;
        worstMean =
            std::max(worstMean, std::abs(mean - golden["L_mean_per_block"][block].get<double>()));
        for (int m : {4, 25, 100, 400}) {
            const auto entropies = SubBlockEntropies(lightness, 200, 200, m);
            const auto& expected = golden["H_svd"][std::to_string(m)][block];
            ASSERT_EQ(entropies.size(), expected.size());
            for (size_t i = 0; i < entropies.size(); ++i)
                worstEntropy =
                    std::max(worstEntropy, std::abs(entropies[i].h - expected[i].get<double>()));
        }
    }
    RecordProperty("worst entropy", std::to_string(worstEntropy * 1e12) + "e-12");
    EXPECT_LT(worstMean, 1e-6);
    EXPECT_LT(worstEntropy, 1e-6);
}

// The elements of all these matrices are doubles; the golden values were computed from just these
// doubles with 50 digits, so that none of them is out of reach. The entropies of the constant
// ones (7e-121, 2e-14) are far below what is asked for.
TEST(SvdEntropy, AgreesOnHardMatrices) {
    double worst = 0;
    for (const nlohmann::json& entry : ReadJson(GoldenFile("svd_entropy_hard.json"))) {
        const int n = entry["n"];
        RowMatrix matrix = RowMatrix::Zero(n, n);
        if (entry.contains("matrix"))
            for (int i = 0; i < n; ++i)
                for (int j = 0; j < n; ++j)
                    matrix(i, j) = entry["matrix"][size_t(i)][size_t(j)].get<double>();
        const double h = ComputeSvdEntropy(matrix).h, expected = entry["H"];
        EXPECT_NEAR(h, expected, 1e-9) << entry["name"];
        worst = std::max(worst, std::abs(h - expected));
    }
    RecordProperty("worst entropy", std::to_string(worst * 1e15) + "e-15");
}

TEST(SvdEntropy, SplitsAfterTheFirstQuarter) {
    // The singular values of a diagonal matrix are its elements: p = .64, .16, .16, .04.
    RowMatrix matrix = RowMatrix::Zero(4, 4);
    matrix.diagonal() << 2, 8, 1e-300, 4;
    matrix(2, 2) = -4;
    const SvdEntropy e = ComputeSvdEntropy(matrix);
    const double log4 = std::log(4.0);
    EXPECT_NEAR(e.h1, -0.64 * std::log(0.64) / log4, 1e-14);
    EXPECT_NEAR(e.h2, -(0.32 * std::log(0.16) + 0.04 * std::log(0.04)) / log4, 1e-14);
    EXPECT_NEAR(e.h, e.h1 + e.h2, 1e-15);
}

TEST(SvdEntropy, DoesNotDependOnScaleOrOrientation) {
    const RowMatrix matrix = RowMatrix::Random(7, 12).array() + 0.5;
    const Eigen::VectorXd s = Eigen::MatrixXd(matrix).jacobiSvd().singularValues();
    const Eigen::ArrayXd p = s.array().square() / s.squaredNorm();
    const double expected = -(p * p.log()).sum() / std::log(7.0);
    for (double scale : {1.0, -3.0, 1e-305, 1e300}) {
        const RowMatrix scaled = scale * matrix, transposed = scaled.transpose();
        EXPECT_NEAR(ComputeSvdEntropy(scaled).h, expected, 1e-13) << scale;
        EXPECT_NEAR(ComputeSvdEntropy(transposed).h, expected, 1e-13) << scale;
    }
}

TEST(SvdEntropy, IsZeroWithoutASpectrum) {
    EXPECT_EQ(ComputeSvdEntropy(RowMatrix::Zero(20, 20)).h, 0);
    EXPECT_EQ(ComputeSvdEntropy(RowMatrix::Ones(1, 20)).h, 0);
    EXPECT_EQ(ComputeSvdEntropy(RowMatrix::Ones(1, 1)).h, 0);
    EXPECT_NEAR(ComputeSvdEntropy(RowMatrix::Constant(20, 20, 100)).h, 0, 1e-13);
    EXPECT_NEAR(ComputeSvdEntropy(RowMatrix::Constant(3, 5, 5e-324)).h, 0, 1e-13);
    EXPECT_NEAR(ComputeSvdEntropy(RowMatrix::Identity(20, 20)).h, 1, 1e-13);
}

TEST(SvdEntropy, RefusesWhatIsNotFinite) {
    for (double bad :
         {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
        RowMatrix matrix = RowMatrix::Ones(4, 4);
        matrix(2, 1) = bad;
        EXPECT_THROW(ComputeSvdEntropy(matrix), std::invalid_argument);
    }
}

TEST(SplitEvenly, DiffersByOneAtMost) {
    EXPECT_EQ(SplitEvenly(200, 4), (std::vector<int>{0, 50, 100, 150, 200}));
    for (int length : {40, 41, 97, 199, 200, 201}) {
        const std::vector<int> starts = SplitEvenly(length, 10);
        ASSERT_EQ(starts.size(), 11u);
        EXPECT_EQ(starts.front(), 0);
        EXPECT_EQ(starts.back(), length);
        for (size_t i = 0; i < 10; ++i) {
            EXPECT_GE(starts[i + 1] - starts[i], length / 10);
            EXPECT_LE(starts[i + 1] - starts[i], length / 10 + 1);
        }
    }
}

TEST(SubBlockEntropies, TakesTheSubBlocksRowByRow) {
    const RowMatrix block = RowMatrix::Random(43, 57).array() + 1;
    const auto entropies = SubBlockEntropies({block.data(), size_t(block.size())}, 57, 43, 25);
    ASSERT_EQ(entropies.size(), 25u);
    const std::vector<int> x = SplitEvenly(57, 5), y = SplitEvenly(43, 5);
    for (size_t v = 0; v < 5; ++v)
        for (size_t u = 0; u < 5; ++u) {
            const RowMatrix piece = block.block(y[v], x[u], y[v + 1] - y[v], x[u + 1] - x[u]);
            EXPECT_EQ(entropies[5 * v + u].h, ComputeSvdEntropy(piece).h);
        }
}

TEST(SubBlockEntropies, RefusesWhatItCannotCut) {
    const std::vector<double> block(40 * 40, 1);
    EXPECT_EQ(SubBlockEntropies(block, 40, 40, 400).size(), 400u);
    EXPECT_THROW(SubBlockEntropies(block, 40, 40, 99), std::invalid_argument);
    EXPECT_THROW(SubBlockEntropies(block, 40, 40, 0), std::invalid_argument);
    EXPECT_THROW(SubBlockEntropies(block, 40, 40, -4), std::invalid_argument);
    EXPECT_THROW(SubBlockEntropies(block, 40, 40, 41 * 41), std::invalid_argument);
    EXPECT_THROW(SubBlockEntropies(block, 40, 41, 100), std::invalid_argument);
}

}  // namespace
}  // namespace lull
