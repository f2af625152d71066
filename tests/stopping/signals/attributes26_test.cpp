#include "stopping/signals/attributes26.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <stdexcept>
#include <vector>

#include "stopping/signals/lightness.h"
#include "tests/shared_folder.h"
#include "tests/stopping/golden_data.h"
#include "tests/stopping/read_png.h"

namespace lull {
namespace {

std::vector<double> WhiteNoise(int count, double level, double deviation, unsigned seed) {
    std::mt19937 generator(seed);
    std::normal_distribution<double> gauss(level, deviation);
    std::vector<double> values;
    for (int i = 0; i < count; ++i) values.push_back(gauss(generator));
    return values;
}

// The golden values are those of OpenCV, SciPy, PyWavelets and scikit-image.
TEST(Attributes26, AgreeOnARealImage) {
    LULL_SHARED_FILE(imagePath, "golden/bathroom_00010.png");
    const nlohmann::json golden = ReadJson(GoldenFile("attributes26_bathroom.json"));
    const std::vector<uint8_t> srgb = ReadPng(imagePath.string(), 800, 800);
    ASSERT_EQ(srgb.size(), 800u * 800 * 3);
    std::vector<double> whole(800 * 800);
    Lightness(srgb, whole);

    double worst = 0, worstSigma = 0;
    for (int block = 0; block < 16; ++block) {
        std::vector<double> lightness;
        for (int y = 0; y < 200; ++y) {
            const auto row = whole.begin() + (block / 4 * 200 + y) * 800 + block % 4 * 200;
            lightness.insert(lightness.end(), row, row + 200);
        }
        const std::array<double, kAttributes> attributes = ComputeAttributes(lightness, 200, 200);
        for (size_t i = 0; i < attributes.size(); ++i) {
            const double expected = golden["blocks"][size_t(block)][i];
            EXPECT_NEAR(attributes[i], expected, 1e-6 * expected) << block << " " << i;
            worst = std::max(worst, std::abs(attributes[i] / expected - 1));
        }
        const double sigma = golden["wavelet_sigma"][size_t(block)];
        worstSigma = std::max(worstSigma, std::abs(DiagonalNoise(lightness, 200, 200) / sigma - 1));
    }
    RecordProperty("worst attribute", std::to_string(worst * 1e12) + "e-12");
    RecordProperty("worst sigma", std::to_string(worstSigma * 1e12) + "e-12");
    EXPECT_LT(worstSigma, 1e-6);
}

// A pixel of 1 among zeros, far from the border: the results of each filter there and in its
// neighbourhood are known.
TEST(Attributes26, AreThoseOfOnePixel) {
    constexpr int side = 20, pixels = side * side;
    std::vector<double> image(pixels, 0.0);
    image[8 * side + 8] = 1;
    const std::array<double, kAttributes> a = ComputeAttributes(image, side, side);
    const auto expect = [&](int filter, double own, const std::vector<double>& others) {
        double sum = 1 - own, squares = (1 - own) * (1 - own);
        for (const double v : others) sum += v, squares += v * v;
        const double mean = sum / pixels;
        EXPECT_NEAR(a[size_t(filter)], mean, 1e-15) << filter;
        EXPECT_NEAR(a[size_t(filter) + 13], std::sqrt(squares / pixels - mean * mean), 1e-12)
            << filter;
    };
    expect(0, 1 / 9.0, std::vector<double>(8, 1 / 9.0));
    expect(1, 1 / 25.0, std::vector<double>(24, 1 / 25.0));
    const double w = std::exp(-0.5), sum = (1 + 2 * w) * (1 + 2 * w);  // 3x3, sigma 1
    std::vector<double> gaussian(4, w / sum);
    gaussian.insert(gaussian.end(), 4, w * w / sum);
    expect(3, 1 / sum, gaussian);
    expect(8, 0, {});  // median
    expect(9, 0, {});
    // Wiener 3x3: the variance is that of a pixel among nine wherever the window sees it.
    const double variance = 1 / 9.0 - 1 / 81.0, noise = 9 * variance / pixels;
    const double share = 1 - noise / variance;
    expect(10, 1 / 9.0 + share * 8 / 9, std::vector<double>(8, (1 - share) / 9));
    // Half of the details of Daubechies 2 and more are 0: they do not count, and those that do are
    // larger than any of Haar.
    EXPECT_GT(DiagonalNoise(image, side, side), 0);
}

TEST(Attributes26, SayHowLargeWhiteNoiseIs) {
    for (const double deviation : {0.01, 1.0, 7.0}) {
        const std::vector<double> noise = WhiteNoise(40000, 50, deviation, 3);
        // The median of 10201 absolute values has a standard deviation of 1.2 %.
        EXPECT_NEAR(DiagonalNoise(noise, 200, 200), deviation, 0.05 * deviation);
        // Shrinkage takes away all details of two levels, 15/16 of the energy.
        const std::array<double, kAttributes> a = ComputeAttributes(noise, 200, 200);
        EXPECT_NEAR(std::hypot(a[12], a[25]), deviation * std::sqrt(15.0 / 16), 0.02 * deviation);
        // An average leaves 8/9 of it beyond reach: 1 - 2/9 + 1/9.
        EXPECT_NEAR(std::hypot(a[0], a[13]), deviation * std::sqrt(8.0 / 9), 0.02 * deviation);
    }
}

// Blocks at the edge of an image have any size.
TEST(Attributes26, TakeAnySize) {
    for (const auto& [width, height] : {std::pair(5, 5), {7, 41}, {64, 5}, {65, 67}, {129, 40}}) {
        const std::vector<double> noise = WhiteNoise(width * height, 50, 2, 9);
        for (const double v : ComputeAttributes(noise, width, height)) {
            EXPECT_GT(v, 0);
            EXPECT_LT(v, 50);
        }
        // Symmetric images stay so, also where a last column has no partner.
        std::vector<double> turned;
        for (int x = 0; x < width; ++x)
            for (int y = 0; y < height; ++y) turned.push_back(noise[size_t(y * width + x)]);
        const auto a = ComputeAttributes(noise, width, height);
        const auto b = ComputeAttributes(turned, height, width);
        for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-9 * a[i]) << i;
    }
}

TEST(Attributes26, AreFiniteWhateverComes) {
    constexpr int side = 40;
    std::vector<std::vector<double>> images;
    for (const double level : {0.0, 1e-300, 50.0, 100.0, 1e300, -1e300})
        images.emplace_back(side * side, level);
    std::vector<double> firefly(side * side, 0.0), checkers, extremes;
    firefly[777] = 100;
    for (int i = 0; i < side * side; ++i) {
        checkers.push_back((i % side + i / side) % 2 ? 100 : 0);
        extremes.push_back(i % 2 ? 1e300 : -1e300);
    }
    images.insert(images.end(), {firefly, checkers, extremes});
    for (const std::vector<double>& image : images)
        for (const double v : ComputeAttributes(image, side, side)) {
            EXPECT_TRUE(std::isfinite(v)) << image[0];
            EXPECT_GE(v, 0);
        }
    // A constant image has only the effect of the zeros around it on median and Wiener.
    const auto flat = ComputeAttributes(images[2], side, side);
    for (const size_t i : {0, 1, 2, 3, 4, 5, 6, 7, 12}) EXPECT_LT(flat[i], 1e-12) << i;
    EXPECT_GT(flat[8], 0);
    const auto black = ComputeAttributes(images[0], side, side);
    EXPECT_TRUE(std::ranges::all_of(black, [](double v) { return v == 0; }));
}

TEST(Attributes26, RefuseWhatIsNoImage) {
    const std::vector<double> image(100, 1.0);
    EXPECT_THROW(ComputeAttributes(image, 10, 11), std::invalid_argument);
    EXPECT_THROW(ComputeAttributes(image, 25, 4), std::invalid_argument);
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        std::vector<double> broken = image;
        broken[55] = bad;
        EXPECT_THROW(ComputeAttributes(broken, 10, 10), std::invalid_argument);
    }
}

}  // namespace
}  // namespace lull
