#include "renderer/vision/convolution.h"

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
