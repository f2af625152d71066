#include "renderer/denoise/worst_pixels.h"

#include <gtest/gtest.h>

namespace lull {
namespace {

// Returns the worst pixels of a grey picture whose pixels of these indices are lighter or darker.
std::vector<size_t> WorstOf(int side, const std::vector<std::pair<size_t, float>>& differences) {
    std::vector<float> grey(size_t(3 * side * side), 0.2f), other = grey,
                                                            lightness(size_t(side * side));
    for (const auto& [pixel, difference] : differences) {
        for (size_t c = 0; c < 3; ++c) other[3 * pixel + c] += difference;
        lightness[pixel] = 100 * difference;
    }
    return WorstPixels(FindVisibleDifference(other, grey, side, side, DisplayModel()), lightness);
}

// The pixels around one that is wrong differ visibly, too, but are right.
TEST(WorstPixels, AreThoseThatAreWrong) {
    constexpr int kSide = 100;  // two of whose pixels are taken
    EXPECT_EQ(WorstOf(kSide, {{2020, 0.2f}, {7070, -0.19f}, {5050, 0.1f}}),
              (std::vector<size_t>{2020, 7070}));
}

TEST(WorstPixels, AreNoneOfSmallBlocks) { EXPECT_TRUE(WorstOf(60, {{1830, 0.2f}}).empty()); }

}  // namespace
}  // namespace lull
