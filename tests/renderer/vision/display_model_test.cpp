#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numeric>

#include "renderer/base/error.h"
#include "renderer/vision/visible_difference.h"

namespace lull::display_test {
namespace {

TEST(ParseDisplay, ReadsWhatNameOfWrites) {
    const DisplayModel display = ParseDisplay("80lux,55.5ppd,200cd");
    EXPECT_EQ(display.peak, 200);
    EXPECT_EQ(display.pixelsPerDegree, 55.5);
    EXPECT_EQ(display.ambient, 80);
    EXPECT_EQ(NameOf(display), "200cd,55.5ppd,80lux");
    EXPECT_EQ(NameOf(ParseDisplay(NameOf(display))), NameOf(display));
}

TEST(ParseDisplay, KeepsDefaults) {
    EXPECT_EQ(NameOf(ParseDisplay("60ppd")), "100cd,60ppd,250lux");
}

TEST(ParseDisplay, RefusesAllElse) {
    for (const char* text : {"", "100", "cd", "100cd,", ",100cd", "100cd,100cd", "100nits", "1e9cd",
                             "0cd", "nancd", "infcd", "4ppd", "501ppd", "-1lux", "100cd 40ppd"})
        EXPECT_THROW(ParseDisplay(text), Error) << text;
}

// 250 lux on a screen that reflects 0.5 % are 0.398 cd/m2.
TEST(DisplayedLight, IsTheDisplaysAndTheRooms) {
    constexpr float inf = std::numeric_limits<float>::infinity();
    const std::vector<float> light = DisplayedLight(
        std::vector<float>{0, 0.5f, 1, 7, inf, -1, -inf, std::numeric_limits<float>::quiet_NaN()},
        ParseDisplay("200cd,250lux"));
    const float black = 0.2f + 0.39789f;
    const float expected[] = {
        black, 0.5f * 199.8f + black, 200.39789f, 200.39789f, 200.39789f, black, black, black};
    for (size_t i = 0; i < light.size(); ++i) EXPECT_NEAR(light[i], expected[i], 1e-4) << i;
}

}  // namespace
}  // namespace lull::display_test

namespace lull::sensitivity_test {
namespace {

// The figures are those of another program that was written from the same formulas.
TEST(ContrastSensitivity, HasKnownValues) {
    const GaborPatch patch{.frequency = 4, .area = 7, .luminance = 30};
    EXPECT_NEAR(ContrastSensitivity(OpponentChannel::Achromatic, patch), 202.81242, 1e-4);
    EXPECT_NEAR(ContrastSensitivity(OpponentChannel::RedGreen, patch), 151.90201, 1e-4);
    EXPECT_NEAR(ContrastSensitivity(OpponentChannel::YellowViolet, patch), 14.12398, 1e-4);
}

// Barten: Formula for the contrast sensitivity of the human eye, Proc. SPIE 5294, 2004, eq. 11.
double Barten(const GaborPatch& patch) {
    const double u = patch.frequency, l = patch.luminance;
    return 5200 * std::exp(-0.0016 * u * u * std::pow(1 + 100 / l, 0.08)) /
           std::sqrt((1 + 144 / patch.area + 0.64 * u * u) *
                     (63 / std::pow(l, 0.83) + 1 / (1 - std::exp(-0.02 * u * u))));
}

// The two models rest on other people and other criteria; Barten's sees fine patches at less
// contrast.
TEST(ContrastSensitivity, IsThatOfBartenWithinEightDecibels) {
    for (const double luminance : {10, 30, 100, 200})
        for (const double frequency : {1, 2, 4, 8})
            for (const double area : {0.25, 1.0}) {
                const GaborPatch patch{frequency, area, luminance};
                const double ratio =
                    ContrastSensitivity(OpponentChannel::Achromatic, patch) / Barten(patch);
                EXPECT_GT(ratio, 0.4) << frequency << " " << luminance;
                EXPECT_LT(ratio, 1) << frequency << " " << luminance;
            }
}

TEST(ContrastSensitivity, PeaksBetweenOneAndEightCyclesADegree) {
    const auto at = [](double frequency) {
        return ContrastSensitivity(OpponentChannel::Achromatic, {.frequency = frequency});
    };
    EXPECT_LT(at(0.25), at(2));
    EXPECT_LT(at(16), at(3));
    EXPECT_LT(at(32), at(16));
}

TEST(ContrastSensitivity, GrowsWithLuminanceAndArea) {
    for (const OpponentChannel channel :
         {OpponentChannel::Achromatic, OpponentChannel::RedGreen, OpponentChannel::YellowViolet}) {
        EXPECT_GT(ContrastSensitivity(channel, {4, 1, 100}),
                  ContrastSensitivity(channel, {4, 1, 1}));
        EXPECT_GT(ContrastSensitivity(channel, {4, 9, 10}),
                  ContrastSensitivity(channel, {4, 1, 10}));
    }
}

TEST(ContrastSensitivity, IsFiniteAtTheEndsOfItsRange) {
    for (const double luminance : {1e-3, 1e4})
        for (const double frequency : {0.05, 64.0, 500.0})
            for (int c = 0; c < kOpponentChannels; ++c) {
                const double s = ContrastSensitivity(OpponentChannel(c), {frequency, 7, luminance});
                EXPECT_TRUE(std::isfinite(s) && s >= 0) << luminance << " " << frequency;
            }
}

}  // namespace
}  // namespace lull::sensitivity_test

namespace lull {
namespace {

TEST(GaussianKernel, HasASumOfOneAndIsSymmetric) {
    const std::vector<double> kernel = GaussianKernel(1.5, 5);
    ASSERT_EQ(kernel.size(), 11u);
    EXPECT_NEAR(std::accumulate(kernel.begin(), kernel.end(), 0.0), 1, 1e-15);
    EXPECT_EQ(kernel[0], kernel[10]);
    EXPECT_NEAR(kernel[4] / kernel[5], std::exp(-0.5 / 2.25), 1e-15);
}

TEST(Filter, CorrelatesInBothDirections) {
    const std::vector<float> dot = {0, 0, 0, 0, 1, 0, 0, 0, 0};
    const std::vector<double> x = {1, 2, 3}, y = {10, 20, 30};
    // A neighbour to the left of the dot sees it on its right, with the weight 3.
    EXPECT_EQ(Convolve(dot, 3, 3, x, y), (std::vector<float>{90, 60, 30, 60, 40, 20, 30, 20, 10}));
}

TEST(Filter, GoesOnWithTheBorder) {
    const std::vector<double> mean = {0.2, 0.2, 0.2, 0.2, 0.2};
    for (const float v : Convolve(std::vector<float>(12, 3.f), 4, 3, mean, mean))
        EXPECT_FLOAT_EQ(v, 3);
    EXPECT_FLOAT_EQ(Convolve(std::vector<float>{1, 0, 0}, 3, 1, mean, std::vector<double>{1})[0],
                    0.6f);
}

}  // namespace
}  // namespace lull

namespace lull::pyramid_test {
namespace {

Plane MakePlane(int width, int height, float (*value)(int, int)) {
    Plane plane{width, height, {}};
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) plane.values.push_back(value(x, y));
    return plane;
}

TEST(ImagePyramid, KeepsWhatIsConstant) {
    for (const auto& [width, height] : {std::pair{1, 1}, {2, 1}, {1, 3}, {5, 4}, {16, 9}}) {
        const Plane plane = MakePlane(width, height, [](int, int) { return 3.f; });
        const Plane half = Reduce(plane);
        EXPECT_EQ(half.width, (width + 1) / 2);
        EXPECT_EQ(half.height, (height + 1) / 2);
        for (const float v : half.values) EXPECT_FLOAT_EQ(v, 3);
        const Plane whole = Expand(half, width, height);
        EXPECT_EQ(whole.values.size(), plane.values.size());
        for (const float v : whole.values) EXPECT_FLOAT_EQ(v, 3);
    }
}

TEST(ImagePyramid, KeepsRampsInside) {
    const Plane plane = MakePlane(32, 24, [](int x, int y) { return float(2 * x - y); });
    const Plane half = Reduce(plane);
    EXPECT_NEAR(half.values[5 * 16 + 7], 2 * 14 - 10, 1e-4);
    const Plane whole = Expand(half, 32, 24);
    for (int y = 6; y < 18; ++y)
        for (int x = 6; x < 26; ++x) EXPECT_NEAR(whole.values[size_t(y * 32 + x)], 2 * x - y, 1e-4);
}

TEST(ImagePyramid, IsSymmetricInXAndY) {
    const auto value = [](int x, int y) { return float((x * 7 + y * 3) % 11); };
    const auto turned = [](int x, int y) { return float((y * 7 + x * 3) % 11); };
    const Plane a = Expand(Reduce(MakePlane(13, 8, value)), 13, 8);
    const Plane b = Expand(Reduce(MakePlane(8, 13, turned)), 8, 13);
    for (int y = 0; y < 8; ++y)
        for (int x = 0; x < 13; ++x)
            EXPECT_NEAR(a.values[size_t(y * 13 + x)], b.values[size_t(x * 8 + y)], 1e-5);
}

// A grating of two pixels is gone.
TEST(ImagePyramid, LosesTheFinest) {
    const Plane half = Reduce(MakePlane(16, 16, [](int x, int) { return x % 2 ? 1.f : -1.f; }));
    for (int x = 1; x < 7; ++x) EXPECT_NEAR(half.values[size_t(3 * 8 + x)], 0, 1e-6);
}

}  // namespace
}  // namespace lull::pyramid_test
