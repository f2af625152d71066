#include "stopping/rules/rule.h"

#include <gtest/gtest.h>

#include <vector>

namespace lull {
namespace {

// Returns the checks up to `end`, where a picture comes every `step` spp.
std::vector<int> ChecksUpTo(int end, const Checks& checks, int step = 1) {
    std::vector<int> due;
    for (int spp = step; spp <= end; spp += step)
        if (checks.AreDue(spp, due.empty() ? 0 : due.back())) due.push_back(spp);
    return due;
}

TEST(Checks, AreAtEachPictureUnlessTheRuleSaysOtherwise) {
    EXPECT_EQ(ChecksUpTo(4, {}), (std::vector<int>{1, 2, 3, 4}));
    EXPECT_EQ(ChecksUpTo(5, {.first = 3}), (std::vector<int>{3, 4, 5}));
}

TEST(Checks, AreAGridFromTheFirst) {
    EXPECT_EQ(ChecksUpTo(150, {.first = 20, .every = 40}), (std::vector<int>{20, 60, 100, 140}));
    // A picture that the grid misses is not checked.
    EXPECT_EQ(ChecksUpTo(200, {.first = 20, .every = 40}, 30), (std::vector<int>{60, 180}));
}

TEST(Checks, AreFarEnoughApartWherePicturesComeAtAnySpp) {
    EXPECT_EQ(ChecksUpTo(200, {.every = 40, .any = true}, 30), (std::vector<int>{30, 90, 150}));
    EXPECT_EQ(ChecksUpTo(100, {.every = 40, .any = true}), (std::vector<int>{1, 41, 81}));
}

TEST(Checks, WaitUntilTheSamplesHaveGrown) {
    EXPECT_EQ(ChecksUpTo(1500, {.first = 40, .growth = 2}, 20),
              (std::vector<int>{40, 80, 160, 320, 640, 1280}));
    EXPECT_EQ(ChecksUpTo(60, {.first = 20, .growth = 1.25}, 10),
              (std::vector<int>{20, 30, 40, 50}));
}

}  // namespace
}  // namespace lull
