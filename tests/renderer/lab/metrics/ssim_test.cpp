#include "renderer/lab/metrics/ssim.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/renderer/lab/example_images.h"

namespace lull {
namespace {

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

}  // namespace
}  // namespace lull
