#include "stopping/lab/observers/agreement.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace lull {
namespace {

TEST(StudentInterval, IsThatOfTheTables) {
    const std::pair<int, double> table[] = {{1, 12.7062}, {2, 4.3027},   {3, 3.1824},
                                            {4, 2.7764},  {9, 2.2622},   {10, 2.2281},
                                            {30, 2.0423}, {1000, 1.9623}};
    for (const auto& [degrees, t] : table) EXPECT_NEAR(StudentInterval(0.95, degrees), t, 1e-4);
    EXPECT_NEAR(StudentInterval(0.99, 5), 4.0321, 1e-4);
    EXPECT_THROW(StudentInterval(0.95, 0), std::invalid_argument);
    EXPECT_THROW(StudentInterval(1, 3), std::invalid_argument);
}

TEST(IntraclassCorrelation, IsThatOfShroutAndFleiss) {
    // The example of the paper: six targets, four judges; ICC(2,1) = 0.29.
    const std::vector<std::vector<double>> ratings = {{9, 2, 5, 8}, {6, 1, 3, 2},  {8, 4, 6, 8},
                                                      {7, 1, 2, 6}, {10, 5, 6, 9}, {6, 2, 4, 7}};
    EXPECT_NEAR(IntraclassCorrelation(ratings).value(), 0.2898, 1e-4);
    const std::vector<std::vector<double>> same = {{1, 1}, {2, 2}, {5, 5}};
    EXPECT_NEAR(IntraclassCorrelation(same).value(), 1, 1e-12);
}

TEST(IntraclassCorrelation, IsNothingWhereItHasNoMeaning) {
    using Ratings = std::vector<std::vector<double>>;
    EXPECT_FALSE(IntraclassCorrelation(Ratings{}));
    EXPECT_FALSE(IntraclassCorrelation(Ratings{{1, 2}}));
    EXPECT_FALSE(IntraclassCorrelation(Ratings{{1}, {2}}));
    EXPECT_FALSE(IntraclassCorrelation(Ratings{{3, 3}, {3, 3}}));
    EXPECT_THROW(IntraclassCorrelation(Ratings{{1, 2}, {3}}), std::invalid_argument);
}

TEST(SampleDeviation, DividesByOneLess) {
    EXPECT_NEAR(SampleDeviation(std::vector<double>{1, 3}).value(), 1.41421356, 1e-8);
    EXPECT_FALSE(SampleDeviation(std::vector<double>{1}));
}

TEST(AgreementInAWord, HasTheBoundsOfKooAndLi) {
    EXPECT_STREQ(AgreementInAWord(-0.1), "poor");
    EXPECT_STREQ(AgreementInAWord(0.5), "moderate");
    EXPECT_STREQ(AgreementInAWord(0.75), "good");
    EXPECT_STREQ(AgreementInAWord(0.9), "excellent");
}

}  // namespace
}  // namespace lull
