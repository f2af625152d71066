#include "stopping/lab/evaluation/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>
#include <vector>

namespace lull {
namespace {

TEST(RankCorrelation, KnowsOrderAlone) {
    const std::vector<double> a = {1, 2, 3, 4, 1000}, b = {-5, 0, 1e-9, 2, 3};
    EXPECT_DOUBLE_EQ(RankCorrelation(a, b).value(), 1);
    const std::vector<double> falling = {5, 4, 3, 2, 1};
    EXPECT_DOUBLE_EQ(RankCorrelation(a, falling).value(), -1);
}

// Spearman's example by hand: ranks 1 2.5 2.5 4 and 1 3 2 4.
TEST(RankCorrelation, SharesRanksOfEqualNumbers) {
    const std::vector<double> a = {1, 7, 7, 9}, b = {1, 3, 2, 4};
    EXPECT_NEAR(RankCorrelation(a, b).value(), 4.5 / std::sqrt(4.5 * 5), 1e-15);
}

TEST(RankCorrelation, IsNothingWithoutOrder) {
    const std::vector<double> two = {1, 2}, same = {3, 3, 3}, three = {1, 2, 3};
    EXPECT_FALSE(RankCorrelation(two, two));
    EXPECT_FALSE(RankCorrelation(same, three));
    EXPECT_THROW(RankCorrelation(two, three), std::invalid_argument);
    const std::vector<double> nan = {1, std::numeric_limits<double>::quiet_NaN(), 2};
    EXPECT_THROW(RankCorrelation(nan, three), std::invalid_argument);
}

}  // namespace
}  // namespace lull
