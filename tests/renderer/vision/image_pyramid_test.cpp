#include "renderer/vision/visible_difference.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

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
