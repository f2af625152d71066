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
#include "tests/stopping/cut_states.h"
#include "tests/stopping/golden_data.h"
#include "tests/stopping/read_png.h"
#include "tests/stopping/signals/block_images.h"

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

constexpr int kSide = 200, kSubBlocks = 100;

// Returns a grey block of lightness 61.7 with independent noise of standard deviation `noise` in L.
BlockImage GreyNoise(double noise, unsigned seed) {
    const double y = 0.3, slope = 116 / 3.0 * std::pow(y, -2 / 3.0);
    std::mt19937 generator(seed);
    std::normal_distribution<double> gauss(0, noise / slope);
    BlockImage image(kSide, kSide, float(y));
    for (size_t i = 0; i < image.mean.size(); i += 3)
        image.mean[i] = image.mean[i + 1] = image.mean[i + 2] = float(y + gauss(generator));
    return image;
}

std::vector<double> Entropies(const BlockView& view) {
    std::vector<double> h;
    for (const SvdEntropy& e : PictureEntropies(view, kSubBlocks)) h.push_back(e.h);
    return h;
}

// Returns the mean visible drop at `spp` of pictures whose noise is sqrt(40 / n^a) times as large
// as at 1 spp would be 1, after those at all looks before.
double VisibleAt(int spp, double scale, double a, const NoiseVisibility& visibility) {
    History<float> history;
    std::optional<std::vector<double>> visible;
    for (int n = 20; n <= spp; n += 40) {
        const BlockImage image = GreyNoise(scale * std::pow(n, -a / 2), unsigned(n));
        const BlockView view = image.At(n);
        AddEntropies(n, Entropies(view), &history);
        visible = LatestVisibleDrop(history, MeasureLightness(view, kSubBlocks), visibility);
    }
    double sum = 0;
    for (const double v : *visible) sum += v / double(visible->size());
    return sum;
}

constexpr NoiseVisibility kPlain = {.mask = 1e9, .flare = 0, .reference = 1 << 30, .nearness = 0.5};

TEST(EntropyDrop, IsTheNoiseButForAConstant) {
    // Whatever the noise is: 0.5 to 4 in L.
    std::vector<double> ratios;
    for (const double noise : {4.0, 2.0, 1.0, 0.5})
        ratios.push_back(VisibleAt(420, noise * std::sqrt(420), 1, kPlain) / noise);
    for (const double ratio : ratios) EXPECT_NEAR(ratio, 1.75, 0.35);
    EXPECT_LT(ratios[0], ratios[3]);  // it hardly changes, by the logarithm of the noise
}

TEST(EntropyDrop, MeansTheSameHoweverFastNoiseFalls) {
    const double random = VisibleAt(420, std::sqrt(420), 1, kPlain);
    for (const double a : {1.25, 1.5, 1.75}) {
        const double fast = VisibleAt(420, std::pow(420, a / 2), a, kPlain);
        EXPECT_NEAR(fast / random, 1, 0.08) << a;
        // Its value without the correction.
        EXPECT_GT(fast * std::sqrt(std::pow(2, a) - 1) / random, 1.1) << a;
    }
}

TEST(EntropyDrop, ReadsTheRateOfTheFall) {
    auto state = [](int spp, double a) {
        return EntropyState{spp, {float(0.2 + std::pow(spp, -a)), float(0.3)}};
    };
    const std::vector<double> weights = {1, 1};
    for (const double a : {1.0, 1.3, 1.6, 1.9})
        EXPECT_NEAR(RateOfFall(state(20, a), state(60, a), state(100, a), weights), a, 1e-3);
    EXPECT_EQ(RateOfFall(state(20, 0.5), state(60, 0.5), state(100, 0.5), weights), 1);
    EXPECT_EQ(RateOfFall(state(20, 2.5), state(60, 2.5), state(100, 2.5), weights), 2);
    // Where entropies rise ever more, or stay, nothing can be said.
    EXPECT_EQ(RateOfFall(state(20, -1), state(60, -1), state(100, -1), weights), 1);
    EXPECT_EQ(RateOfFall(state(20, 1), state(20, 1), state(20, 1), weights), 1);
    // A sub-block counts as its weight says.
    EntropyState odd = state(60, 1.3);
    odd.values[1] = 0.9f;
    EXPECT_NEAR(RateOfFall(state(20, 1.3), odd, state(100, 1.3), std::vector<double>{1, 0}), 1.3,
                1e-3);
}

TEST(EntropyDrop, IsBroughtToWhatIsLeft) {
    // Noise adds 1 / n; from 60 to 100 it falls by 1/60 - 1/100, and 1/100 is left.
    const EntropyState before{60, {float(0.2 + 1 / 60.0)}}, now{100, {float(0.2 + 1 / 100.0)}};
    EXPECT_NEAR(EntropyDrop(before, now, 1)[0], 0.1, 1e-5);
    // Fireflies that come make it rise: noise as well.
    const EntropyState risen{100, {float(0.2 + 1 / 60.0 + (1 / 60.0 - 1 / 100.0))}};
    EXPECT_NEAR(EntropyDrop(before, risen, 1)[0], 0.1, 1e-5);
}

TEST(VisibleDrop, CountsWhatIsSeen) {
    const std::vector<double> drop = {0.02, 0.02};
    const SubBlockLightness lightness{.mean = {60, 60}, .deviation = {0, 24}};
    const NoiseVisibility visibility{.mask = 24, .flare = 0, .reference = 10000, .nearness = 0.5};
    const auto at = [&](int spp) { return VisibleDrop(drop, lightness, spp, visibility); };
    EXPECT_NEAR(at(100)[0], 0.02 * 60 * std::sqrt(0.99), 1e-6);
    EXPECT_NEAR(at(100)[1], at(100)[0] / 2, 1e-9);
    EXPECT_NEAR(at(7500)[0], 0.02 * 60 * 0.5, 1e-6);
    EXPECT_EQ(at(10000)[0], 0);
    EXPECT_EQ(at(20000)[0], 0);
}

TEST(FlareFactor, HidesWhatIsDark) {
    EXPECT_DOUBLE_EQ(FlareFactor(50, 0), 1);
    double last = 0;
    for (const double l : {8.0, 20.0, 40.0, 60.0, 80.0, 100.0}) {
        const double factor = FlareFactor(l, 0.05);
        EXPECT_GE(factor, last) << l;
        EXPECT_LE(factor, 1) << l;
        last = factor;
    }
    for (const double l : {0.0, 4.0}) EXPECT_NEAR(FlareFactor(l, 0.05), 0.3, 0.03);
    // The derivative of the lightness of (Y + 0.05) / 1.05.
    auto lightness = [](double y) { return 116 * std::cbrt(y) - 16; };
    const double y = 0.1, e = 1e-6;
    const double expected = (lightness((y + e + 0.05) / 1.05) - lightness((y + 0.05) / 1.05)) /
                            (lightness(y + e) - lightness(y));
    EXPECT_NEAR(FlareFactor(lightness(y), 0.05), expected, 1e-5);
}

TEST(MeasureLightness, DescribesSubBlocks) {
    BlockImage image(40, 20, 0.3f);
    for (int y = 0; y < 20; ++y)
        for (int x = 20; x < 40; ++x)
            for (int c = 0; c < 3; ++c) image.Mean(x, y)[c] = (x + y) % 2 ? 1.f : 0.f;
    const SubBlockLightness lightness = MeasureLightness(image.At(20), 4);
    const double grey = 116 * std::cbrt(0.3) - 16;
    EXPECT_NEAR(lightness.mean[0], grey, 1e-3);
    EXPECT_NEAR(lightness.deviation[0], 0, 1e-2);
    EXPECT_NEAR(lightness.mean[1], 50, 1e-3);
    EXPECT_NEAR(lightness.deviation[3], 50, 1e-3);
    EXPECT_THROW(MeasureLightness(image.At(20), 5), std::invalid_argument);
    EXPECT_THROW(MeasureLightness(BlockImage(9, 40, 0).At(20), 100), std::invalid_argument);
    image.mean[0] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_TRUE(std::isfinite(MeasureLightness(image.At(20), 4).mean[0]));
}

TEST(History, KeepsAFewStatesAnOctave) {
    History<float> history;
    size_t most = 0;
    for (int spp = 20; spp <= 100000; spp += 40) {
        history.Add({spp, {}});
        history.Thin(4);
        const auto& states = history.States();
        most = std::max(most, states.size());
        EXPECT_EQ(states.back().spp, spp);
        for (size_t i = 0; i + 2 < states.size(); ++i)
            EXPECT_TRUE(History<float>::IsStep(states[i].spp, states[i + 1].spp));
        if (spp < 200) continue;
        // Half and a quarter are there, to 5 % late and to half of 40 spp early.
        for (const double part : {2.0, 4.0}) {
            const BlockState<float>* found = history.Nearest(spp / part, 1.6);
            ASSERT_TRUE(found) << spp;
            EXPECT_NEAR(found->spp, spp / part, 21 + 0.05 * spp / part) << spp;
        }
    }
    EXPECT_LE(most, 19u);
}

TEST(History, FindsNothingFarAway) {
    History<float> history;
    history.Add({20, {}});
    EXPECT_FALSE(history.Nearest(20, 1.6));  // only what comes before the last
    EXPECT_EQ(history.At(20), &history.States()[0]);
    EXPECT_FALSE(history.At(40));
    history.Add({60, {}});
    EXPECT_EQ(history.Nearest(20, 1.6), &history.States()[0]);
    EXPECT_FALSE(history.Nearest(50, 1.6));
}

TEST(History, ForgetsWhatItIsToldTo) {
    History<float> history;
    for (const int spp : {20, 40, 60}) history.Add({spp, {}});
    history.ForgetBelow(40);
    ASSERT_EQ(history.States().size(), 2u);
    EXPECT_EQ(history.States()[0].spp, 40);
}

// Entropies of two sub-blocks to which noise adds 1 / n.
std::vector<double> EntropiesAt(int spp) { return {0.2 + 1.0 / spp, 0.4 + 4.0 / spp}; }

TEST(LatestDrop, ComparesWithHalfOfTheSamples) {
    History<float> history;
    const std::vector<double> weights = {1, 1};
    EXPECT_FALSE(LatestDrop(history, weights));
    AddEntropies(20, EntropiesAt(20), &history);
    EXPECT_FALSE(LatestDrop(history, weights));
    for (int spp = 60; spp <= 10000; spp += 40) {
        AddEntropies(spp, EntropiesAt(spp), &history);
        const auto drop = LatestDrop(history, weights);
        ASSERT_TRUE(drop) << spp;
        EXPECT_NEAR((*drop)[0] * std::sqrt(spp), 1, 0.02) << spp;
        EXPECT_NEAR((*drop)[1] * std::sqrt(spp), 2, 0.04) << spp;
    }
    EXPECT_LE(history.States().size(), 19u);
}

TEST(History, RefusesWhatDoesNotFit) {
    History<float> history;
    AddEntropies(60, EntropiesAt(60), &history);
    EXPECT_THROW(AddEntropies(60, EntropiesAt(60), &history), std::invalid_argument);
    EXPECT_THROW(AddEntropies(100, std::vector<double>{1}, &history), std::invalid_argument);
    const std::vector<double> broken = {0.1, std::numeric_limits<double>::quiet_NaN()};
    EXPECT_THROW(AddEntropies(100, broken, &history), std::invalid_argument);
    EXPECT_THROW(LatestDrop(history, std::vector<double>{1}), std::invalid_argument);
    EXPECT_THROW(History<float>().Add({0, {}}), std::invalid_argument);
}

TEST(History, GoesOnAfterARestart) {
    History<float> first, second;
    const std::vector<double> weights = {1, 1};
    for (int spp = 20; spp <= 820; spp += 40) AddEntropies(spp, EntropiesAt(spp), &first);
    StateWriter writer;
    first.Save(&writer);
    StateReader reader(writer.bytes);
    second.Restore(&reader, 2);
    reader.Finish();
    for (int spp = 860; spp <= 2000; spp += 40) {
        for (History<float>* history : {&first, &second})
            AddEntropies(spp, EntropiesAt(spp), history);
        EXPECT_EQ(*LatestDrop(second, weights), *LatestDrop(first, weights));
    }

    const auto restore = [](std::span<const std::byte> state) {
        StateReader damaged(state);
        History<float>().Restore(&damaged, 2);
    };
    ExpectRefusesCut(writer.bytes, 5, restore);
    writer.bytes[4] = writer.bytes[5] = std::byte(0xff);  // an spp beyond the next one
    EXPECT_THROW(restore(writer.bytes), std::runtime_error);
}

}  // namespace
}  // namespace lull
