#include "renderer/lab/metrics/image_error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

#include "renderer/base/error.h"
#include "renderer/base/math.h"
#include "tests/renderer/lab/example_images.h"

namespace lull {
namespace {

RgbImage Even(int width, int height, float value) {
    return {width, height, std::vector<float>(size_t(width) * size_t(height) * 3, value)};
}

// Returns the linear image of which the display image is `srgb`.
RgbImage Linear(const std::vector<uint8_t>& srgb) {
    RgbImage image{kExampleWidth, kExampleHeight, {}};
    for (const uint8_t v : srgb) image.values.push_back(LinearFromSrgb(float(v) / 255));
    return image;
}

TEST(CompareImages, FindsNoErrorInTheSameImage) {
    const RgbImage image = Linear(ExampleImages().image);
    const ErrorFigures f = Average(CompareImages(image, image));
    EXPECT_EQ(f.rmse, 0);
    EXPECT_EQ(f.relMse, 0);
    EXPECT_EQ(f.rmseLightness, 0);
    EXPECT_TRUE(std::isinf(f.psnr));
    EXPECT_NEAR(f.ssim, 1, 1e-6);
    EXPECT_EQ(f.flip, 0);
    EXPECT_EQ(f.visibleDifference, 0);
}

TEST(CompareImages, MeasuresLinearErrorsAndTheDisplayImage) {
    const ErrorFigures f = Average(CompareImages(Even(20, 20, 0.75f), Even(20, 20, 0.5f)));
    EXPECT_NEAR(f.rmse, 0.25, 1e-7);
    EXPECT_NEAR(f.relMse, 0.0625 / 0.26, 1e-7);
    // 8-bit values 188 and 225 of linear 0.5 and 0.75; L of luminances 0.5029 and 0.7529.
    EXPECT_NEAR(f.psnr, 20 * std::log10(255.0 / (225 - 188)), 1e-6);
    const double a = LinearFromSrgb(225 / 255.f), b = LinearFromSrgb(188 / 255.f);
    EXPECT_NEAR(f.rmseLightness, 116 * (std::cbrt(a) - std::cbrt(b)), 1e-3);
}

// scikit-image and the authors' FLIP have computed these of the display images.
TEST(CompareImages, AgreesWithOtherPrograms) {
    const ExampleImages e;
    const ErrorFigures f = Average(CompareImages(Linear(e.image), Linear(e.reference)));
    EXPECT_NEAR(f.psnr, 26.5195325, 1e-5);
    EXPECT_NEAR(f.ssim, 0.9058999, 1e-6);
    EXPECT_NEAR(f.flip, 0.1022064, 2e-5);
    EXPECT_NEAR(f.visibleDifference, 11.37628, 1e-3);
}

TEST(CompareImages, TakesWhatIsNotFiniteAsBlack) {
    RgbImage image = Even(12, 12, 0.f);
    image.values[0] = std::numeric_limits<float>::quiet_NaN();
    image.values[1] = std::numeric_limits<float>::infinity();
    const ErrorFigures f = Average(CompareImages(image, Even(12, 12, 0.f)));
    EXPECT_EQ(f.rmse, 0);
    EXPECT_EQ(f.relMse, 0);
}

TEST(CompareImages, RefusesOtherSizes) {
    EXPECT_THROW(CompareImages(Even(4, 3, 0), Even(3, 4, 0)), Error);
}

TEST(Average, IsOverThePartAskedFor) {
    RgbImage image = Even(40, 20, 0.5f);
    const RgbImage reference = image;
    for (int y = 0; y < 20; ++y)
        for (int x = 20; x < 40; ++x)
            for (int c = 0; c < 3; ++c)
                image.values[3 * (size_t(y) * 40 + size_t(x)) + size_t(c)] = 0.7f;
    const ErrorMaps maps = CompareImages(image, reference);
    EXPECT_EQ(Average(maps, {{0, 0}, {20, 20}}).rmse, 0);
    EXPECT_NEAR(Average(maps, {{20, 0}, {40, 20}}).rmse, 0.2, 1e-6);
    EXPECT_NEAR(Average(maps).rmse, 0.2 / std::sqrt(2), 1e-6);
    // At the border there is no window inside the image.
    EXPECT_TRUE(std::isnan(Average(maps, {{0, 0}, {4, 20}}).ssim));
}

const std::vector<PixelRect> kBlocks = {
    {{0, 0}, {100, 100}}, {{100, 0}, {200, 100}}, {{0, 100}, {100, 200}}, {{100, 100}, {200, 200}}};

// Makes noise of deviation `left` in the left half, `right` in the other; 200 x 200 pixels.
std::vector<float> Noise(float left, float right) {
    std::mt19937 random(7);
    std::normal_distribution<float> normal;
    std::vector<float> noise;
    for (int i = 0; i < 200 * 200; ++i)
        noise.push_back(normal(random) * (i % 200 < 100 ? left : right));
    return noise;
}

TEST(MeasureSeams, SeesNoBorderInEvenNoise) {
    const Seams seams = MeasureSeams(Noise(1, 1), 200, kBlocks);
    EXPECT_NEAR(seams.Ratio(), 1, 0.35);
    EXPECT_LT(seams.border, 0.1);
}

// One of the two kinds of borders, of the same length, has a jump of 2; the other has none.
TEST(MeasureSeams, SeesWhereTheNoiseJumps) {
    const Seams seams = MeasureSeams(Noise(1, 3), 200, kBlocks);
    EXPECT_NEAR(seams.border, 1, 0.1);
    EXPECT_GT(seams.Ratio(), 5);
}

TEST(MeasureSeams, GrowsWithTheNoise) {
    const Seams one = MeasureSeams(Noise(1, 3), 200, kBlocks),
                two = MeasureSeams(Noise(2, 6), 200, kBlocks);
    EXPECT_NEAR(two.border, 2 * one.border, 1e-5);
    EXPECT_NEAR(two.Ratio(), one.Ratio(), 1e-5);
}

TEST(MeasureSeams, KnowsNoRatioWithoutBordersOrNoise) {
    const std::vector<PixelRect> whole = {{{0, 0}, {200, 200}}};
    EXPECT_TRUE(std::isnan(MeasureSeams(Noise(1, 1), 200, whole).Ratio()));
    EXPECT_TRUE(std::isnan(MeasureSeams(Noise(0, 0), 200, kBlocks).Ratio()));
}

TEST(MeasureSeams, LeavesOutBlocksThatAreTooNarrow) {
    const std::vector<PixelRect> blocks = {{{0, 0}, {195, 200}}, {{195, 0}, {200, 200}}};
    EXPECT_EQ(MeasureSeams(Noise(1, 3), 200, blocks).border, 0);
}

double MeanOfNumbers(const std::vector<float>& map) {
    double sum = 0;
    int count = 0;
    for (const float v : map)
        if (!std::isnan(v)) {
            sum += double(v);
            ++count;
        }
    return sum / count;
}

size_t Place(int x, int y) { return size_t(y) * kExampleWidth + x; }

// The figures are those of scikit-image 0.19 with Wang's settings, and of a direct evaluation of
// the paper's sums, window by window.
TEST(SsimMap, AgreesWithOtherPrograms) {
    const ExampleImages e;
    const std::vector<float> map = SsimMap(e.image, e.reference, kExampleWidth, kExampleHeight);
    EXPECT_NEAR(MeanOfNumbers(map), 0.9058998900, 1e-6);
    EXPECT_NEAR(map[Place(5, 5)], 0.8606929982, 1e-5);
    EXPECT_NEAR(map[Place(32, 24)], 0.9530256816, 1e-5);
}

TEST(SsimMap, HasNoValueWhereTheWindowWouldLeaveTheImage) {
    const ExampleImages e;
    const std::vector<float> map = SsimMap(e.image, e.reference, kExampleWidth, kExampleHeight);
    EXPECT_TRUE(std::isnan(map[Place(4, 20)]));
    EXPECT_TRUE(std::isnan(map[Place(20, kExampleHeight - 5)]));
    EXPECT_FALSE(std::isnan(map[Place(5, kExampleHeight - 6)]));
    const std::vector<uint8_t> small(3 * 10 * 10, 7);
    for (const float v : SsimMap(small, small, 10, 10)) EXPECT_TRUE(std::isnan(v));
}

TEST(SsimMap, IsOneForTheSameImageAndSymmetric) {
    const ExampleImages e;
    for (const float v : SsimMap(e.image, e.image, kExampleWidth, kExampleHeight))
        if (!std::isnan(v)) {
            EXPECT_FLOAT_EQ(v, 1);
        }
    const std::vector<float> ab = SsimMap(e.image, e.reference, kExampleWidth, kExampleHeight),
                             ba = SsimMap(e.reference, e.image, kExampleWidth, kExampleHeight);
    for (size_t i = 0; i < ab.size(); ++i)
        if (!std::isnan(ab[i])) {
            EXPECT_FLOAT_EQ(ab[i], ba[i]);
        }
}

// Of two even images, only the means differ: (2 a b + c1) / (a^2 + b^2 + c1).
TEST(SsimMap, ComparesTheMeansOfEvenImages) {
    const std::vector<uint8_t> dark(3 * 11 * 11, 60), light(3 * 11 * 11, 120);
    const double c1 = 2.55 * 2.55;
    EXPECT_NEAR(MeanOfNumbers(SsimMap(dark, light, 11, 11)),
                (2 * 60 * 120 + c1) / (60 * 60 + 120 * 120 + c1), 1e-6);
}

std::vector<float> Flip(const std::vector<uint8_t>& a, const std::vector<uint8_t>& b) {
    return FlipMap(a, b, kExampleWidth, kExampleHeight, DefaultPixelsPerDegree());
}

double Mean(const std::vector<float>& map) {
    return std::accumulate(map.begin(), map.end(), 0.0) / double(map.size());
}

TEST(DefaultPixelsPerDegree, IsThatOfThePaper) {
    EXPECT_NEAR(DefaultPixelsPerDegree(), 67.0206, 1e-4);
}

// The figures are those of the authors' own program, FLIP.h of version 1.6.
TEST(FlipMap, AgreesWithTheAuthorsProgram) {
    const ExampleImages e;
    const std::vector<float> map = Flip(e.image, e.reference);
    EXPECT_NEAR(Mean(map), 0.1022064, 2e-5);
    EXPECT_NEAR(map.front(), 0.038113, 1e-4);
    EXPECT_NEAR(map[24 * kExampleWidth + 32], 0.081828, 1e-4);
    EXPECT_NEAR(map.back(), 0.086663, 1e-4);
}

TEST(FlipMap, IsZeroForTheSameImageAndSymmetric) {
    const ExampleImages e;
    for (const float v : Flip(e.image, e.image)) EXPECT_EQ(v, 0);
    const std::vector<float> ab = Flip(e.image, e.reference), ba = Flip(e.reference, e.image);
    for (size_t i = 0; i < ab.size(); ++i) EXPECT_FLOAT_EQ(ab[i], ba[i]);
}

// The scale ends at the two colours of a display that are furthest apart: green and blue.
TEST(FlipMap, IsOneBetweenGreenAndBlue) {
    std::vector<uint8_t> green, blue;
    for (int i = 0; i < kExampleWidth * kExampleHeight; ++i) {
        green.insert(green.end(), {0, 255, 0});
        blue.insert(blue.end(), {0, 0, 255});
    }
    for (const float v : Flip(green, blue)) EXPECT_NEAR(v, 1, 1e-3);
}

TEST(FlipMap, GrowsWithTheNoise) {
    const ExampleImages e;
    std::vector<uint8_t> half = e.image;
    for (size_t i = 0; i < half.size(); ++i) half[i] = uint8_t((half[i] + e.reference[i]) / 2);
    EXPECT_LT(Mean(Flip(half, e.reference)), Mean(Flip(e.image, e.reference)));
}

}  // namespace
}  // namespace lull
