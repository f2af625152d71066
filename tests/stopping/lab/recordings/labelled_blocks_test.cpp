#include "stopping/lab/recordings/labelled_blocks.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/stopping/lab/training/learning_data.h"

namespace lull {
namespace {

// Stores warnings.
struct Listener {
    std::vector<std::string> said;
    WarningSink Ear() {
        return [this](const std::string& message) { said.push_back(message); };
    }
};

TEST(LabelledBlocks, AreThoseThatPeopleJudged) {
    const LearningData data;
    Listener listener;
    const auto read = [&](const std::vector<std::string>& without) {
        listener.said.clear();
        return ReadLabelledBlocks(data.viewpoints, data.human.path, without, listener.Ear());
    };
    EXPECT_EQ(read({}).size(), 7u);
    EXPECT_EQ(listener.said,
              std::vector<std::string>{data.human.path + " has no thresholds for 'cellar'"});
    EXPECT_EQ(read({"barn"}).size(), 4u);
    EXPECT_EQ(read({"cellar"}).size(), 7u);
    EXPECT_TRUE(listener.said.empty());
    EXPECT_THROW(read({"attic", "barn"}), std::runtime_error);
    EXPECT_THROW(read({"shed"}), std::runtime_error);
}

TEST(LabelledBlocks, NameTheFileThatDoesNotFit) {
    const LearningData data;
    const ScratchFile shorter(".csv", "attic;40;40;\n");
    try {
        ReadLabelledBlocks(data.viewpoints, shorter.path, {}, [](const std::string&) {});
        FAIL();
    } catch (const std::runtime_error& error) {
        EXPECT_TRUE(std::string(error.what()).starts_with(shorter.path + ": ")) << error.what();
    }
}

TEST(LabelledBlocks, AreReadFromSeveralFilesAsOne) {
    const LearningData data, other;
    const std::vector<ViewpointRecording> all = ReadDatasets({data.dataset.path});
    EXPECT_EQ(all.size(), 3u);
    EXPECT_EQ(ReadDatasets({data.dataset.path, other.dataset.path}).size(), 3u);
    EXPECT_THROW(ReadDatasets({data.human.path}), std::runtime_error);
}

TEST(LabelledBlocks, HaveAllThatIsAskedFor) {
    LearningData data;
    data.viewpoints[0].blocks.at(2).absent.set(ChannelIndex("attributes26"));
    const std::vector<LabelledBlock> blocks = data.Blocks();
    const ModelSettings entropy, attributes{.features = ParseFeatures("attributes26")};
    Listener listener;
    EXPECT_EQ(KeepRecorded(blocks, entropy, listener.Ear()).size(), 7u);
    EXPECT_TRUE(listener.said.empty());
    EXPECT_EQ(KeepRecorded(blocks, attributes, listener.Ear()).size(), 6u);
    EXPECT_EQ(listener.said,
              std::vector<std::string>{"1 of 7 blocks were recorded without attributes26"});
    for (ViewpointRecording& viewpoint : data.viewpoints)
        for (auto& [number, block] : viewpoint.blocks)
            block.absent.set(ChannelIndex("attributes26"));
    EXPECT_THROW(KeepRecorded(blocks, attributes, listener.Ear()), std::runtime_error);
}

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
