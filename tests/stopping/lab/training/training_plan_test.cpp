#include "stopping/lab/training/training_plan.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "tests/stopping/lab/training/learning_data.h"

namespace lull {
namespace {

std::vector<std::string> Names(const std::vector<BlockSplit>& splits) {
    std::vector<std::string> names;
    for (const BlockSplit& split : splits) names.push_back(split.name);
    return names;
}

TEST(TrainingPlan, TrainsOneOnAllUnlessToldOtherwise) {
    const LearningData data;
    TrainingPlan plan = data.Plan();
    const std::vector<LabelledBlock> blocks = data.Blocks();
    EXPECT_EQ(Names(MakeSplits(plan, blocks)), std::vector<std::string>{""});
    plan.crossValidate = true;
    EXPECT_EQ(Names(MakeSplits(plan, blocks)),
              (std::vector<std::string>{"without attic", "without barn", ""}));
    EXPECT_TRUE(MakeSplits(plan, blocks).back().test.empty());
    plan.withLast = false;
    EXPECT_EQ(Names(MakeSplits(plan, blocks)),
              (std::vector<std::string>{"without attic", "without barn"}));
}

TEST(TrainingPlan, LeavesOutByNameOrByAFile) {
    const LearningData data;
    TrainingPlan plan = data.Plan();
    plan.leaveOut = {"barn"};
    const BlockSplit named = MakeSplits(plan, data.Blocks()).at(0);
    EXPECT_EQ(named.training.size(), 4u);
    EXPECT_EQ(named.test.size(), 3u);
    const ScratchFile listed(".csv", "attic;0;3;\nbarn;1;\n");
    plan.leaveOut.clear();
    plan.split = listed.path;
    EXPECT_EQ(MakeSplits(plan, data.Blocks()).at(0).training.size(), 3u);
    plan.leaveOut = {"shed"};
    EXPECT_THROW(MakeSplits(plan, data.Blocks()), std::runtime_error);
    plan.leaveOut.clear();
    plan.crossValidate = true;
    const std::vector<LabelledBlock> blocks = data.Blocks();
    EXPECT_THROW(MakeSplits(plan, std::span(blocks).first(4)), std::runtime_error);  // one only
}

TEST(TrainingPlan, NeedsTheRecordingsPasses) {
    CheckSpacing({.n = 60, .voteSpacing = 40}, 20);
    EXPECT_THROW(CheckSpacing({.n = 30, .voteSpacing = 40}, 20), std::runtime_error);
    EXPECT_THROW(CheckSpacing({.n = 40, .voteSpacing = 50}, 20), std::runtime_error);
}

TEST(TrainingPlan, IsRecorded) {
    const LearningData data;
    const TrainingPlan plan = data.Plan();
    const BlockSplit split = MakeSplits(plan, data.Blocks()).at(0);
    const auto record = MakeRecord(plan, split);
    EXPECT_EQ(record.at("version"), "test");
    EXPECT_EQ(record.at("training_blocks"), "attic: 0 1 2 3\nbarn: 0 1 2");
    EXPECT_EQ(record.at("test_blocks"), "none");
    EXPECT_EQ(record.at("learning_rate"), "0.001");
    EXPECT_NE(record.at("human").find(".csv crc32:"), std::string::npos);
    EXPECT_EQ(MakeRecord(plan, split), record);
}

}  // namespace
}  // namespace lull
