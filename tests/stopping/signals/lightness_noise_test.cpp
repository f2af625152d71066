#include "stopping/signals/lightness_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>

#include "stopping/signals/lightness.h"
#include "tests/stopping/signals/block_images.h"

namespace lull {
namespace {

double LightnessOf(double y) {
    return y > 0.008856 ? 116 * std::cbrt(y) - 16 : 116 * (7.787 * y + 16 / 116.0) - 16;
}
double SlopeOf(double y) { return y > 0.008856 ? 116 / 3.0 * std::pow(y, -2 / 3.0) : 116 * 7.787; }

// Returns the estimates for a block of one pixel.
LightnessNoise OfPixel(const std::vector<float>& mean, const std::vector<float>& half) {
    return ComputeLightnessNoise({1, 1, 20, mean, half});
}

double Rms(const std::vector<float>& values) {
    double sum = 0;
    for (float v : values) sum += double(v) * v;
    return std::sqrt(sum / double(values.size()));
}

TEST(LightnessNoise, IsTheDifferenceOfTheHalvesInLightness) {
    const LightnessNoise grey = OfPixel({0.2f, 0.2f, 0.2f}, {0.21f, 0.21f, 0.21f});
    EXPECT_NEAR(grey.lightness[0], LightnessOf(0.2), 1e-4);
    EXPECT_NEAR(grey.noise[0], SlopeOf(0.2) * 0.01, 1e-5);
    EXPECT_NEAR(grey.halfNoise[0], (LightnessOf(0.21) - LightnessOf(0.19)) / 2, 2e-5);
    EXPECT_EQ(grey.texture[0], 0);

    const LightnessNoise dark = OfPixel({0.004f, 0.004f, 0.004f}, {0.003f, 0.003f, 0.003f});
    EXPECT_NEAR(dark.lightness[0], 116 * 7.787 * 0.004, 1e-4);
    EXPECT_NEAR(dark.noise[0], -116 * 7.787 * 0.001, 1e-5);
    EXPECT_NEAR(dark.halfNoise[0], -116 * 7.787 * 0.001, 1e-5);

    const LightnessNoise coloured = OfPixel({0.5f, 0.2f, 0.1f}, {0.4f, 0.23f, 0.3f});
    const double y = 0.212671 * 0.5 + 0.715160 * 0.2 + 0.072169 * 0.1;
    const double change = -0.212671 * 0.1 + 0.715160 * 0.03 + 0.072169 * 0.2;
    EXPECT_NEAR(coloured.noise[0], SlopeOf(y) * change, 1e-4);
}

TEST(LightnessNoise, IgnoresWhatTheDisplaySaturates) {
    const LightnessNoise red = OfPixel({1.5f, 0.3f, 0.1f}, {2.5f, 0.33f, 0.1f});
    const double y = 0.212671 + 0.715160 * 0.3 + 0.072169 * 0.1;
    EXPECT_NEAR(red.lightness[0], LightnessOf(y), 1e-4);
    EXPECT_NEAR(red.noise[0], SlopeOf(y) * 0.715160 * 0.03, 1e-4);

    BlockImage white(20, 20, 3);
    for (size_t i = 0; i < white.halfMean.size(); i += 2) white.halfMean[i] = 1.5f;
    const LightnessNoise noise = ComputeLightnessNoise(white.At(20));
    for (size_t i = 0; i < noise.noise.size(); ++i) {
        EXPECT_NEAR(noise.lightness[i], 100, 1e-4);
        EXPECT_EQ(noise.noise[i], 0);
        EXPECT_EQ(noise.halfNoise[i], 0);
        EXPECT_EQ(noise.texture[i], 0);
    }
}

TEST(LightnessNoise, MeasuresGaussianNoise) {
    // Samples of deviation 0.05 around a grey: the mean of 20 has the deviation 0.05 / sqrt(20). Of
    // 40000 pixels, the RMS has a relative standard error of 1 / sqrt(80000); the noise is at most
    // 3 % from linear.
    const int side = 200, spp = 20;
    const double deviation = 0.05, truth = 0.3;
    std::mt19937 generator(5);
    std::normal_distribution<double> half(truth, deviation / std::sqrt(spp / 2.0));
    BlockImage image(side, side, 0);
    double squaredError = 0;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x) {
            const double a = half(generator), b = half(generator);
            std::fill_n(image.HalfMean(x, y), 3, float(a));
            std::fill_n(image.Mean(x, y), 3, float((a + b) / 2));
            const double error = LightnessOf((a + b) / 2) - LightnessOf(truth);
            squaredError += error * error / (side * side);
        }
    const double expected = SlopeOf(truth) * deviation / std::sqrt(double(spp));
    const double standardError = 1 / std::sqrt(2.0 * side * side);
    EXPECT_NEAR(std::sqrt(squaredError) / expected, 1, 3 * standardError + 0.002);

    const LightnessNoise noise = ComputeLightnessNoise(image.At(spp));
    EXPECT_NEAR(Rms(noise.noise) / expected, 1, 3 * standardError + 0.002);
    EXPECT_NEAR(Rms(noise.halfNoise) / expected, 1, 3 * standardError + 0.002);

    const LightnessNoiseStatistics one = SubBlockStatistics(noise, side, side, 1);
    EXPECT_FLOAT_EQ(one.noise[0], float(Rms(noise.noise)));
    // Averaging 5 x 5 leaves a fifth of the noise in L, which is the only texture.
    EXPECT_NEAR(one.texture[0] / (expected / 5), 1, 0.1);
    EXPECT_NEAR(one.deviation[0] / expected, 1, 3 * standardError + 0.002);

    // Each of 100 sub-blocks has 400 pixels; their squares average to those of the block.
    double squares = 0;
    for (float rms : SubBlockStatistics(noise, side, side, 100).noise) {
        EXPECT_NEAR(rms / expected, 1, 5 / std::sqrt(800.0));
        squares += double(rms) * rms / 100;
    }
    EXPECT_NEAR(std::sqrt(squares), one.noise[0], 1e-5);
}

TEST(LightnessNoise, SeesTheTextureOfAnEdge) {
    // White begins at column 12 and L steps by 100 there. Smoothing by 5 makes 0, .2, .4, .6, .8, 1
    // of it; the window of 13 around column 12 has four zeros, these and four more ones.
    BlockImage image(40, 30, 0);
    for (int y = 0; y < 30; ++y)
        for (int x = 12; x < 40; ++x) std::fill_n(image.Mean(x, y), 3, 1.f);
    image.halfMean = image.mean;
    const LightnessNoise noise = ComputeLightnessNoise(image.At(20));
    const double atEdge = 100 * std::sqrt(6.2 / 13 - std::pow(7 / 13.0, 2));
    for (int y = 0; y < 30; ++y) {
        const float* row = &noise.texture[size_t(y) * 40];
        EXPECT_NEAR(row[12], atEdge, 1e-3);
        EXPECT_NEAR(row[11], atEdge, 1e-3);  // zeros and ones change places
        EXPECT_GT(row[4], 1);                // column 10, the first that is not black, is in reach
        EXPECT_NEAR(row[3], 0, 1e-3);
        EXPECT_NEAR(row[20], 0, 1e-3);
    }
    EXPECT_EQ(Rms(noise.noise), 0);
}

TEST(LightnessNoise, ClipsWindowsAtTheBorders) {
    // White begins at column 3. Smoothing within the block makes 0, 1/4, 2/5, 3/5, 4/5, 1, 1 of the
    // first columns, which are all that the window of the first pixel has.
    BlockImage image(20, 20, 0);
    for (int y = 0; y < 20; ++y)
        for (int x = 3; x < 20; ++x) std::fill_n(image.Mean(x, y), 3, 1.f);
    image.halfMean = image.mean;
    const LightnessNoise noise = ComputeLightnessNoise(image.At(20));
    const double expected = 100 * std::sqrt(3.2225 / 7 - std::pow(4.05 / 7, 2));
    for (size_t corner : {size_t(0), size_t(19 * 20)})
        EXPECT_NEAR(noise.texture[corner], expected, 1e-3);
}

TEST(LightnessNoise, IsMaskedByTexture) {
    EXPECT_EQ(MaskedNoise(0.8f, 0), 0.8f);
    EXPECT_EQ(MaskedNoise(-0.8f, 4), -0.4f);
}

TEST(LightnessNoise, CollectsStatisticsOfSubBlocks) {
    // Four sub-blocks of 2 x 1 pixels; the texture masks the noise of the last.
    LightnessNoise pixels;
    pixels.lightness = {10, 20, 30, 30, 0, 100, 50, 60};
    pixels.noise = {1, -1, 3, 4, 0, 0, 1, 7};
    pixels.halfNoise = {0, 2, -1, 1, 0, 0, 3, -3};
    pixels.texture = {0, 0, 0, 0, 1, 3, 0, 4};
    const LightnessNoiseStatistics s = SubBlockStatistics(pixels, 4, 2, 4);
    const auto expect = [](const std::vector<float>& values, const std::vector<float>& expected) {
        ASSERT_EQ(values.size(), expected.size());
        for (size_t i = 0; i < values.size(); ++i) EXPECT_FLOAT_EQ(values[i], expected[i]) << i;
    };
    expect(s.lightness, {15, 30, 50, 55});
    expect(s.deviation, {5, 0, 50, 5});
    expect(s.texture, {0, 0, 2, 2});
    expect(s.noise, {1, std::sqrt(12.5f), 0, 5});
    expect(s.maskedNoise, {1, std::sqrt(12.5f), 0, std::sqrt((1 + 12.25f) / 2)});
    expect(s.halfNoise, {std::sqrt(2.f), 1, 0, 3});
}

TEST(LightnessNoise, LeavesNoNan) {
    const float inf = std::numeric_limits<float>::infinity();
    const float values[] = {
        0, -1, 0.5f, 3.4e38f, -3.4e38f, 1e-38f, inf, -inf, std::numeric_limits<float>::quiet_NaN()};
    for (float mean : values)
        for (float half : values) {
            BlockImage image(20, 20, mean);
            image.halfMean.assign(image.mean.size(), half);
            std::fill_n(image.Mean(3, 3), 3, 0.2f);
            const LightnessNoise noise = ComputeLightnessNoise(image.At(20));
            const LightnessNoiseStatistics s = SubBlockStatistics(noise, 20, 20, 4);
            for (const auto* all :
                 {&noise.lightness, &noise.noise, &noise.halfNoise, &noise.texture, &s.lightness,
                  &s.deviation, &s.texture, &s.noise, &s.maskedNoise, &s.halfNoise})
                for (float v : *all) EXPECT_TRUE(std::isfinite(v)) << mean << ", " << half;
        }
}

TEST(PeakNoise, CountsFewPixelsWithMuchNoise) {
    // One dark pixel in 400 has all its light in one half: 20 L* there are 20 / 400^(1/4) in all.
    BlockImage block(20, 20, 0.f);
    const float light = float((std::pow((40 + 16) / 116.0, 3)));  // L = 40 in the half that has it
    for (int c = 0; c < 3; ++c) {
        block.Mean(10, 10)[c] = light / 2;
        block.HalfMean(10, 10)[c] = light;
    }
    LightnessNoise noise = ComputeLightnessNoise(block.At(20));
    EXPECT_NEAR(noise.halfNoise[10 * 20 + 10], 20, 1e-3);
    noise.texture.assign(400, 0.f);
    EXPECT_NEAR(PeakNoise(noise), 20 / std::pow(400, 0.25), 1e-3);
    noise.texture.assign(400, 4.f);
    EXPECT_NEAR(PeakNoise(noise), 10 / std::pow(400, 0.25), 1e-3);
    EXPECT_EQ(PeakNoise({}), 0);
}

TEST(PeakNoise, IsThatOfTheSubBlocks) {
    const BlockImage block = NoisyBlock(60, 60, 0.3, 40, 7);
    const LightnessNoise noise = ComputeLightnessNoise(block.At(40));
    const std::vector<float> peaks = SubBlockStatistics(noise, 60, 60, 100).peak;
    EXPECT_NEAR(PeakOf(peaks), PeakNoise(noise), 1e-5 * PeakNoise(noise));
    EXPECT_EQ(PeakOf({}), 0);
    // Bell-shaped noise has a kurtosis of three.
    std::vector<float> masked;
    for (size_t i = 0; i < noise.halfNoise.size(); ++i)
        masked.push_back(MaskedNoise(noise.halfNoise[i], noise.texture[i]));
    EXPECT_NEAR(PeakNoise(noise) / Rms(masked), std::pow(3, 0.25), 0.15);
}

// Lit rectangles, with noise, in a block without any: they may be no noisier than where they fill
// the block, wherever they are, however small and beside whatever level.
TEST(LocalPeakNoise, IsThatOfTheLitPixelsAlone) {
    struct Window {
        int x, y, width, height;
    };
    const auto peakOf = [](const std::vector<Window>& windows, double noise, double dark) {
        BlockImage block(200, 200, float(dark));
        const BlockImage noisy = NoisyBlock(200, 200, noise, 40, 11);
        for (const Window& window : windows)
            for (int y = window.y; y < window.y + window.height; ++y)
                for (int x = window.x; x < window.x + window.width; ++x)
                    for (int c = 0; c < 3; ++c) {
                        const size_t i = size_t(3 * (200 * y + x) + c);
                        block.Mean(x, y)[c] = noisy.mean[i];
                        block.HalfMean(x, y)[c] = noisy.halfMean[i];
                    }
        return LocalPeakNoise(ComputeLightnessNoise(block.At(40)), 200, 200);
    };
    for (const double noise : {0.05, 0.3}) {
        const double whole = peakOf({{0, 0, 200, 200}}, noise, 0);
        for (const double dark : {0., 0.01, 0.18, 0.8}) {
            const auto expect = [&](const std::vector<Window>& windows, double least, double most) {
                const auto& [x, y, width, height] = windows[0];
                SCOPED_TRACE(testing::Message()
                             << noise << " " << dark << " " << x << " " << y << " " << width << "x"
                             << height << " " << windows.size());
                const double ratio = peakOf(windows, noise, dark) / whole;
                EXPECT_GT(ratio, least);
                EXPECT_LT(ratio, most);
            };
            for (const int at : {0, 77, 100}) {
                for (const int side : {12, 16, 24, 48, 100})
                    expect({{at, at, side, side}}, 0.6, 1.4);
                expect({{at, at, 4, 4}}, 0.35, 1.4);
                expect({{at, at, 6, 6}}, 0.5, 1.4);
                expect({{at, at, 8, 8}}, 0.5, 1.4);
                // Strips across the block, a cross of them, and a corner.
                for (const int thickness : {4, 6, 10}) {
                    const Window row = {0, at, 200, thickness}, column = {at, 0, thickness, 200};
                    expect({row}, 0.6, 1.4);
                    expect({column}, 0.6, 1.4);
                    expect({row, column}, 0.6, 1.4);
                    expect({{at, at, 60, thickness}, {at, at, thickness, 60}}, 0.6, 1.4);
                }
            }
        }
    }
}

TEST(LightnessNoise, RefusesOtherSizes) {
    const BlockImage image(20, 20, 1);
    BlockView view = image.At(20);
    view.halfMean = {};
    EXPECT_THROW(ComputeLightnessNoise(view), std::invalid_argument);
    const LightnessNoise noise = ComputeLightnessNoise(image.At(20));
    for (int bad : {-1, 0, 2, 99, 441})
        EXPECT_THROW(SubBlockStatistics(noise, 20, 20, bad), std::invalid_argument) << bad;
    EXPECT_THROW(SubBlockStatistics(noise, 20, 21, 4), std::invalid_argument);
    EXPECT_THROW(SubBlockStatistics({}, 20, 20, 4), std::invalid_argument);
}

}  // namespace
}  // namespace lull
