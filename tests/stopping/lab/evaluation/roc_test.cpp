#include "stopping/lab/evaluation/statistics.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>
#include <vector>

namespace lull {
namespace {

double Area(const std::vector<float>& scores, const std::vector<char>& labels) {
    return AreaUnderRoc(scores, labels);
}

TEST(AreaUnderRoc, CountsPairsInTheRightOrder) {
    EXPECT_EQ(Area({0.1f, 0.2f, 0.8f, 0.9f}, {0, 0, 1, 1}), 1);
    EXPECT_EQ(Area({0.1f, 0.2f, 0.8f, 0.9f}, {1, 1, 0, 0}), 0);
    EXPECT_EQ(Area({0.1f, 0.4f, 0.35f, 0.8f}, {0, 0, 1, 1}), 0.75);
    EXPECT_EQ(Area({5, 5, 5, 5}, {0, 1, 0, 1}), 0.5);
    EXPECT_EQ(Area({1, 5, 5, INFINITY}, {0, 1, 0, 1}), 0.875);
    EXPECT_EQ(Area({}, {}), 0.5);
    EXPECT_EQ(Area({1, 2}, {1, 1}), 0.5);
    EXPECT_THROW(Area({1, 2}, {1}), std::invalid_argument);
    EXPECT_THROW(Area({1, NAN}, {1, 0}), std::invalid_argument);
}

TEST(AreaUnderRoc, IsWhatItsDefinitionSays) {
    std::mt19937 generator(1);
    std::vector<float> scores;
    std::vector<char> labels;
    for (int i = 0; i < 200; ++i) {
        scores.push_back(float(generator() % 20));
        labels.push_back(generator() % 3 == 0);
    }
    double right = 0, pairs = 0;
    for (size_t i = 0; i < scores.size(); ++i)
        for (size_t j = 0; j < scores.size(); ++j)
            if (labels[i] && !labels[j]) {
                ++pairs;
                right += scores[i] > scores[j] ? 1 : scores[i] == scores[j] ? 0.5 : 0;
            }
    EXPECT_NEAR(Area(scores, labels), right / pairs, 1e-12);
}

}  // namespace
}  // namespace lull
