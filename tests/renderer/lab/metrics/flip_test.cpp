#include "renderer/lab/metrics/flip.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/renderer/lab/example_images.h"

namespace lull {
namespace {

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
