#include "stopping/rules/block_grid.h"

#include <gtest/gtest.h>

#include <vector>

namespace lull {
namespace {

// Returns the leaders in an image cut into blocks of 200 pixels a side.
std::vector<int> Leaders(int width, int height) {
    return CutIntoBlocks(width, height, 200).leaders;
}

TEST(BlockGrid, HasWhatIsLeftAsSmallerBlocks) {
    const BlockGrid grid = CutIntoBlocks(439, 210, 200);
    EXPECT_EQ(grid.columns, 3);
    EXPECT_EQ(grid.blocks, (std::vector<BlockRect>{{0, 0, 200, 200},
                                                   {200, 0, 200, 200},
                                                   {400, 0, 39, 200},
                                                   {0, 200, 200, 10},
                                                   {200, 200, 200, 10},
                                                   {400, 200, 39, 10}}));
    EXPECT_EQ(CutIntoBlocks(500, 300, 65536).blocks, (std::vector<BlockRect>{{0, 0, 500, 300}}));
    EXPECT_TRUE(CutIntoBlocks(0, 300, 200).blocks.empty());
    EXPECT_TRUE(CutIntoBlocks(300, 0, 200).blocks.empty());
}

TEST(BlockGrid, HasNoFollowersWhereAnyBlockIsLargeEnough) {
    EXPECT_EQ(CutIntoBlocks(439, 200, 200, 0).leaders, (std::vector<int>{0, 1, 2}));
}

TEST(SmallBlocks, AreCheckedFrom40PixelsOn) {
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

}  // namespace
}  // namespace lull
