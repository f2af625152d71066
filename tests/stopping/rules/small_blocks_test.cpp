#include "stopping/rules/small_blocks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <stdexcept>
#include <vector>

namespace lull {
namespace {

// Returns the leaders in an image cut into blocks of 200 pixels a side.
std::vector<int> Leaders(int width, int height) {
    std::vector<BlockSize> sizes;
    for (int y = 0; y < height; y += 200)
        for (int x = 0; x < width; x += 200)
            sizes.push_back({std::min(200, width - x), std::min(200, height - y)});
    return BlockLeaders((width + 199) / 200, sizes);
}

TEST(SmallBlocks, JudgeThemselvesFrom40PixelsOn) {
    EXPECT_EQ(Leaders(800, 200), (std::vector<int>{0, 1, 2, 3}));
    EXPECT_EQ(Leaders(440, 240), (std::vector<int>{0, 1, 2, 3, 4, 5}));
}

TEST(SmallBlocks, FollowTheLargestNeighbour) {
    EXPECT_EQ(Leaders(439, 200), (std::vector<int>{0, 1, 1}));
    // Below the last, small row: the first of the largest three above; in the corner as well.
    EXPECT_EQ(Leaders(439, 439), (std::vector<int>{0, 1, 1, 3, 4, 1, 3, 3, 4}));
    // A neighbour that is large enough to vote, but not the largest.
    EXPECT_EQ(Leaders(230, 330), (std::vector<int>{0, 0, 2, 0}));
}

TEST(SmallBlocks, HaveNoLeaderInASmallImage) {
    EXPECT_EQ(Leaders(30, 30), (std::vector<int>{-1}));
    EXPECT_EQ(Leaders(1000, 39), (std::vector<int>{-1, -1, -1, -1, -1}));
}

TEST(SmallBlocks, TakeTheThresholdOfTheLeader) {
    const std::vector<int> thresholds = {100, 200, 300}, leaders = {0, 0, -1};
    EXPECT_EQ(FollowLeaders(thresholds, leaders, 10000), (std::vector<int>{100, 100, 10000}));
    EXPECT_THROW(FollowLeaders(thresholds, std::vector<int>{0}, 10000), std::invalid_argument);
    EXPECT_THROW(BlockLeaders(2, std::vector<BlockSize>(3, {200, 200})), std::invalid_argument);
}

}  // namespace
}  // namespace lull
