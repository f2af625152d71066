#include "stopping/lab/evaluation/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

namespace lull {
namespace {

TEST(Bootstrap, IsAPointWhereAllIsTheSame) {
    const std::vector<std::vector<double>> values = {{0.25, 0.25}, {0.25}};
    const Interval interval = BootstrapInterval(values);
    EXPECT_EQ(interval.low, 0.25);
    EXPECT_EQ(interval.high, 0.25);
}

// The mean of 100 blocks of one viewpoint scatters by a tenth of the scatter of blocks.
TEST(Bootstrap, HasTheWidthOfTheMean) {
    std::mt19937 generator(7);
    std::normal_distribution<double> gauss(5, 2);
    std::vector<std::vector<double>> values(1);
    for (int i = 0; i < 100; ++i) values[0].push_back(gauss(generator));
    const Interval interval = BootstrapInterval(values);
    EXPECT_NEAR(interval.high - interval.low, 2 * 1.96 * 2 / 10, 0.15);
    EXPECT_LT(interval.low, 5.3);
    EXPECT_GT(interval.high, 4.7);
}

// Differences between viewpoints alone are not known better by more blocks.
TEST(Bootstrap, DrawsViewpoints) {
    const std::vector<std::vector<double>> values = {std::vector<double>(50, 0.0),
                                                     std::vector<double>(50, 1.0)};
    const Interval interval = BootstrapInterval(values);
    EXPECT_EQ(interval.low, 0);
    EXPECT_EQ(interval.high, 1);
}

TEST(Bootstrap, RefusesNothing) {
    EXPECT_THROW(BootstrapInterval({}), std::invalid_argument);
    const std::vector<std::vector<double>> empty = {{1.0}, {}};
    EXPECT_THROW(BootstrapInterval(empty), std::invalid_argument);
}

}  // namespace
}  // namespace lull
