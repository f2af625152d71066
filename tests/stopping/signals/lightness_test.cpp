#include "stopping/signals/lightness.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace lull {
namespace {

uint8_t Encode(float x) {
    uint8_t code = 0;
    EncodeSrgb8({&x, 1}, {&code, 1});
    return code;
}

double CodeLightness(uint8_t r, uint8_t g, uint8_t b) {
    const std::array<uint8_t, 3> rgb = {r, g, b};
    double lightness = -1;
    Lightness(rgb, {&lightness, 1});
    return lightness;
}

TEST(EncodeSrgb8, AgreesWithTheCurveEverywhere) {
    for (int i = 0; i <= 1000000; ++i) {
        const float x = float(i) / 1000000;
        const double v =
            x <= 0.0031308 ? 12.92 * double(x) : 1.055 * std::pow(double(x), 1 / 2.4) - 0.055;
        const double code = 255 * v;
        // At a tie, up to the rounding of pow(), either neighbour is right.
        ASSERT_LE(std::abs(Encode(x) - code), 0.5 + 1e-6) << "x = " << x;
    }
}

TEST(EncodeSrgb8, ReturnsEveryCodeToItself) {
    for (int c = 0; c < 256; ++c) {
        const double v = c / 255.0;
        const double x = v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
        EXPECT_EQ(Encode(float(x)), c);
    }
}

TEST(EncodeSrgb8, ClampsAndSurvivesNonsense) {
    const float infinity = std::numeric_limits<float>::infinity();
    EXPECT_EQ(Encode(-1), 0);
    EXPECT_EQ(Encode(-0.f), 0);
    EXPECT_EQ(Encode(std::numeric_limits<float>::denorm_min()), 0);
    EXPECT_EQ(Encode(std::nextafter(1.f, 0.f)), 255);
    EXPECT_EQ(Encode(1), 255);
    EXPECT_EQ(Encode(1e30f), 255);
    EXPECT_EQ(Encode(infinity), 255);
    EXPECT_EQ(Encode(-infinity), 0);
    EXPECT_EQ(Encode(std::numeric_limits<float>::quiet_NaN()), 0);
}

TEST(Lightness, HasTheKnownValues) {
    EXPECT_EQ(CodeLightness(0, 0, 0), 0);
    EXPECT_NEAR(CodeLightness(255, 255, 255), 100, 1e-9);
    EXPECT_NEAR(CodeLightness(128, 128, 128), 53.58501345216902, 1e-9);
    EXPECT_NEAR(CodeLightness(0, 255, 0), 116 * std::cbrt(0.715160) - 16, 1e-9);
    EXPECT_NEAR(CodeLightness(1, 1, 1), 116 * 7.787 / 12.92 / 255, 1e-4);  // the linear part
}

TEST(Lightness, IsThatOfDisplayedColours) {
    const std::vector<float> linear = {0, 0, 0, 7, 1, 2, 0.2122308f, -1, 0};
    const std::vector<double> lightness = lull::LightnessOf(linear);
    ASSERT_EQ(lightness.size(), 3u);
    EXPECT_EQ(lightness[0], 0);
    EXPECT_NEAR(lightness[1], 100, 1e-9);
    EXPECT_EQ(lightness[2], CodeLightness(127, 0, 0));
}

TEST(Lightness, RefusesOtherLengths) {
    std::vector<uint8_t> srgb(5);
    std::vector<double> lightness(2);
    std::vector<float> linear(4);
    EXPECT_THROW(Lightness(srgb, lightness), std::invalid_argument);
    EXPECT_THROW(EncodeSrgb8(linear, srgb), std::invalid_argument);
}

}  // namespace
}  // namespace lull
