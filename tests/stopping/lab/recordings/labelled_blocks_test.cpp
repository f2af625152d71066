#include "stopping/lab/recordings/labelled_blocks.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "stopping/features/model_inputs.h"
#include "tests/stopping/lab/recordings/made_up_recordings.h"
#include "tests/stopping/lab/training/learning_data.h"
#include "tests/stopping/scratch_file.h"

namespace lull {
namespace {

TEST(JoinHuman, FindsRowsByTheirExactNames) {
    const std::vector<ViewpointRecording> viewpoints = {MakeViewpoint("a", 3, 400),
                                                        MakeViewpoint("b", 2, 400)};
    std::vector<std::string> unknown;
    const std::vector<LabelledBlock> blocks =
        JoinHuman(viewpoints, std::vector{MakeHumanRow("b"), MakeHumanRow("a-view0")}, &unknown);
    EXPECT_EQ(unknown, std::vector<std::string>{"a"});
    ASSERT_EQ(blocks.size(), 2u);
    EXPECT_EQ(blocks[1].viewpoint, "b");
    EXPECT_EQ(blocks[1].block, 1);
    EXPECT_EQ(blocks[1].human, 22 * 22);
    EXPECT_EQ(blocks[1].recording, &viewpoints[1].blocks.at(1));
}

TEST(JoinHuman, RefusesWhatDoesNotFit) {
    std::vector<ViewpointRecording> viewpoints = {MakeViewpoint("a", 1, 400),
                                                  MakeViewpoint("a", 1, 400)};
    const std::vector<ThresholdsRow> human = {MakeHumanRow("a"), MakeHumanRow("b")};
    EXPECT_THROW(JoinHuman(viewpoints, human, nullptr), std::invalid_argument);
    viewpoints[1].name = "b";
    EXPECT_NO_THROW(JoinHuman(viewpoints, human, nullptr));
    viewpoints[1].passSpp = 10;
    EXPECT_THROW(JoinHuman(viewpoints, human, nullptr), std::invalid_argument);
    viewpoints[1].passSpp = 20;
    viewpoints[1].blockCount = 4;
    EXPECT_THROW(JoinHuman(viewpoints, human, nullptr), std::invalid_argument);
}

TEST(MakeSamples, NeedTheAttributesOfEachBlock) {
    std::vector<ViewpointRecording> viewpoints = {MakeViewpoint("a", 3, 400)};
    viewpoints[0].blocks[1].absent.set(ChannelIndex("attributes26"));
    const std::vector<LabelledBlock> blocks =
        JoinHuman(viewpoints, std::vector{MakeHumanRow("a")}, nullptr);
    const ModelSettings settings = {.features = ParseFeatures("H,attributes26")};
    EXPECT_EQ(InputVector(MeasuresOf(*blocks[0].recording, 0, settings), settings).size(), 126u);
    EXPECT_THROW(MakeSamples(blocks, settings), std::invalid_argument);
}

TEST(MakeSamples, EndWindowsOnTheGrid) {
    const std::vector<ViewpointRecording> viewpoints = {MakeViewpoint("a", 2, 1000)};
    const std::vector<LabelledBlock> blocks =
        JoinHuman(viewpoints, std::vector{MakeHumanRow("a")}, nullptr);
    const TrainingSamples samples = MakeSamples(blocks, {});
    // 300, 340, ..., 980 spp of two blocks with the human thresholds 400 and 484.
    ASSERT_EQ(samples.Count(), 36u);
    EXPECT_EQ(samples.windowSize, 800);
    EXPECT_EQ(samples.windows.size(), 36u * 800);
    for (size_t i = 0; i < 36; ++i)
        EXPECT_EQ(int(samples.noisy[i]), 300 + 40 * int(i % 18) < (i < 18 ? 400 : 484)) << i;

    // They are the windows that a rule would see which looks at every recorded pass.
    History<double> history;
    const BlockRecording& recording = viewpoints[0].blocks.at(1);
    for (int i = 0, sample = 18; i < recording.Count(); ++i) {
        const int spp = recording.spp[size_t(i)];
        AddInputs(spp, InputVector(MeasuresOf(recording, i, {}), {}), {}, &history);
        if (spp < 300 || (spp - 20) % 40 != 0) continue;
        const Eigen::Map<const Eigen::MatrixXf> window(&samples.windows[size_t(sample++) * 800],
                                                       100, 8);
        EXPECT_TRUE(window == *WindowOf(history, {}, spp)) << spp;
    }
}

TEST(MakeSamples, RefusesWhatIsNotRecorded) {
    const std::vector<ViewpointRecording> viewpoints = {MakeViewpoint("a", 1, 1000)};
    const std::vector<LabelledBlock> blocks =
        JoinHuman(viewpoints, std::vector{MakeHumanRow("a")}, nullptr);
    for (int m : {4, 25, 400}) {
        EXPECT_EQ(MakeSamples(blocks, {.m = m}).windowSize, 8 * m);
        EXPECT_THROW(MakeSamples(blocks, {.m = m, .features = {Feature::H1}}),
                     std::invalid_argument);
    }
    EXPECT_NO_THROW(MakeSamples(blocks, {.features = {Feature::H1, Feature::H2}}));
    EXPECT_THROW(MakeSamples(blocks, {.m = 16}), std::invalid_argument);
    EXPECT_THROW(MakeSamples(blocks, {.n = 20}), std::invalid_argument);
    EXPECT_THROW(MakeSamples(blocks, {.n = 60}), std::invalid_argument);
    EXPECT_EQ(MakeSamples(blocks, {.k = 1, .n = 80}).Count(), 13u);
}

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
    const auto read = [&] {
        ReadLabelledBlocks(data.viewpoints, shorter.path, {}, [](const std::string&) {});
    };
    EXPECT_TRUE(WhatOf(read).starts_with(shorter.path + ": ")) << WhatOf(read);
}

TEST(LabelledBlocks, AreReadFromSeveralFilesAsOne) {
    const LearningData data, other;
    EXPECT_EQ(ReadDatasets({data.dataset.path}).size(), 3u);
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
