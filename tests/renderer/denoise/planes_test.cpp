#include "renderer/denoise/planes.h"

#include <gtest/gtest.h>

#include "tests/renderer/denoise/example_pictures.h"

namespace lull {
namespace {

TEST(Planes, AreFilteredByBoxes) {
    const Planes image = MakePlanes(
        7, 5, 2, [](int c, int x, int y) { return c == 0 ? x * x + 10 * y : (x == 3 && y == 2); });
    const Planes sum = BoxSum(image, 2), mean = BoxMean(image, 2);
    for (int c = 0; c < 2; ++c)
        for (int y = 0; y < 5; ++y)
            for (int x = 0; x < 7; ++x) {
                double expected = 0;
                int count = 0;
                for (int v = std::max(0, y - 2); v <= std::min(4, y + 2); ++v)
                    for (int u = std::max(0, x - 2); u <= std::min(6, x + 2); ++u, ++count)
                        expected += image.Row(c, v)[u];
                EXPECT_FLOAT_EQ(sum.Row(c, y)[x], float(expected));
                EXPECT_FLOAT_EQ(mean.Row(c, y)[x], float(expected / count));
            }
}

// What a bright value adds to a running sum has to go again without a trace.
TEST(Planes, AreNotSpoiledByBrightValues) {
    Planes image(64, 64, 1, 1e-3f);
    image.Row(0, 10)[10] = 1e8f;
    const Planes mean = BoxMean(image, 3);
    EXPECT_FLOAT_EQ(mean.Row(0, 50)[10], 1e-3f);
    EXPECT_FLOAT_EQ(mean.Row(0, 10)[50], 1e-3f);
}

// Pictures are filtered part by part.
TEST(Planes, AreFilteredAlikeInParts) {
    std::mt19937 generator(1);
    std::normal_distribution<double> gauss(0, 1);
    const Planes image = MakePlanes(50, 40, 1, [&](int, int, int) { return gauss(generator); });
    const Planes part = Crop(image, {9, 7, 45, 40});
    EXPECT_EQ(Crop(BoxMean(image, 4), {13, 11, 41, 40}).values,
              Crop(BoxMean(part, 4), {4, 4, 32, 33}).values);
}

TEST(Planes, VaryByHalfTheirSquaredDifference) {
    Planes a(3, 2, 2, 1), b(3, 2, 2, 1);
    b.Row(1, 1)[2] = -3;
    Planes expected(3, 2, 2);
    expected.Row(1, 1)[2] = 8;
    EXPECT_EQ(VarianceOf(a, b).values, expected.values);
}

}  // namespace
}  // namespace lull
