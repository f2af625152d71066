#include "stopping/lab/recordings/block_split.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace lull {
namespace {

std::vector<LabelledBlock> Blocks() {
    std::vector<LabelledBlock> blocks;
    for (const char* name : {"a", "b", "c"})
        for (int i = 0; i < 4; ++i) blocks.push_back({.viewpoint = name, .block = i});
    return blocks;
}

TEST(BlockSplit, LeavesViewpointsOut) {
    const std::vector<std::string> names = {"a", "c"};
    const BlockSplit split = LeaveOut(Blocks(), names);
    EXPECT_EQ(split.name, "a, c");
    EXPECT_EQ(split.training.size(), 4u);
    EXPECT_EQ(split.training[3].viewpoint, "b");
    EXPECT_EQ(split.test.size(), 8u);
    EXPECT_EQ(LeaveOut(Blocks(), {}).training.size(), 12u);
    const std::vector<std::string> unknown = {"d"};
    EXPECT_THROW(LeaveOut(Blocks(), unknown), std::invalid_argument);
}

TEST(BlockSplit, LeavesEachViewpointOutInTurn) {
    const std::vector<BlockSplit> splits = LeaveEachOut(Blocks());
    ASSERT_EQ(splits.size(), 3u);
    for (const BlockSplit& split : splits) {
        EXPECT_EQ(split.training.size(), 8u);
        for (const LabelledBlock& block : split.test) EXPECT_EQ(block.viewpoint, split.name);
        for (const LabelledBlock& block : split.training) EXPECT_NE(block.viewpoint, split.name);
    }
    EXPECT_THROW(LeaveEachOut(std::vector{Blocks()[0]}), std::invalid_argument);
}

TEST(BlockSplit, LeavesViewsOfASceneOutTogether) {
    std::vector<LabelledBlock> blocks = Blocks();
    for (LabelledBlock& block : blocks)
        if (block.viewpoint != "b") block.viewpoint = "room-" + block.viewpoint;
    const std::vector<std::string> rooms = {"room"}, towns = {"town"}, all = {"b", "room"};
    const std::vector<BlockSplit> splits = LeaveEachOut(blocks, rooms);
    ASSERT_EQ(splits.size(), 2u);
    EXPECT_EQ(splits[0].name, "room-a, room-c");
    EXPECT_EQ(splits[0].test.size(), 8u);
    EXPECT_EQ(splits[1].name, "b");
    EXPECT_EQ(splits[1].training.size(), 8u);
    EXPECT_EQ(LeaveEachOut(blocks, all).size(), 2u);
    EXPECT_THROW(LeaveEachOut(blocks, towns), std::invalid_argument);
}

TEST(BlockSplit, KeepsListedBlocks) {
    BlockSplit split = LeaveOut(Blocks(), std::vector<std::string>{"c"});
    const std::vector<ThresholdsRow> rows = {{"a", {3, 0}}, {"b", {1}}};
    KeepListed(rows, &split);
    ASSERT_EQ(split.training.size(), 3u);
    EXPECT_EQ(split.training[1].block, 3);
    EXPECT_EQ(split.training[2].viewpoint, "b");
    EXPECT_EQ(split.test.size(), 9u);
    split = LeaveOut(Blocks(), {});
    EXPECT_THROW(KeepListed(rows, &split), std::invalid_argument);
}

}  // namespace
}  // namespace lull
