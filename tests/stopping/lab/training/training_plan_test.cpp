#include "stopping/lab/training/training_plan.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <stdexcept>

#include "stopping/network/model_file.h"
#include "tests/stopping/lab/training/learning_data.h"

namespace lull {
namespace {

// Compares the settings in the file of a model with a preset.
void ExpectTrainedBy(const TrainingPreset& preset, const Model& model) {
    ModelSettings settings = model.settings;
    settings.voteSpacing = preset.settings.voteSpacing;  // which a training sets to n
    EXPECT_TRUE(settings == preset.settings);
}

TEST(TrainingPreset, IsThatOfTheModelThatShips) {
    const TrainingPreset& preset = TrainingPresets().front();
    const Model model = ReadModel(LULL_SOURCE_DIR "/stopping/models/" + preset.name + ".h5");
    ExpectTrainedBy(preset, model);
    ASSERT_EQ(model.network.lstm.size(), preset.training.units.size());
    for (size_t i = 0; i < model.network.lstm.size(); ++i)
        EXPECT_EQ(model.network.lstm[i].Units(), preset.training.units[i]);
}

TEST(TrainingPreset, HasThePaperForOthers) {
    ASSERT_EQ(TrainingPresets().size(), 2u);
    const TrainingPreset& preset = TrainingPresets()[1];
    EXPECT_EQ(preset.name, "paper");
    EXPECT_EQ(preset.training.units, (std::vector<int>{512, 128, 32}));
    ExpectTrainedBy(preset, ReadModel(LULL_SOURCE_DIR "/stopping/models/paper.h5"));
}

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
    CheckSpacing({.n = 60}, 20);
    EXPECT_THROW(CheckSpacing({.n = 30}, 20), std::runtime_error);
}

TEST(TrainingPlan, IsRecorded) {
    const LearningData data;
    const TrainingPlan plan = data.Plan();
    const BlockSplit split = MakeSplits(plan, data.Blocks()).at(0);
    const auto record = MakeRecord(plan, split, {}, {});
    EXPECT_EQ(record.at("version"), "test");
    EXPECT_EQ(record.at("training_blocks"), "attic: 0 1 2 3\nbarn: 0 1 2");
    EXPECT_EQ(record.at("test_blocks"), "none");
    EXPECT_EQ(record.at("learning_rate"), "0.001");
    EXPECT_HAS(record.at("human"), ".csv crc32:");
    EXPECT_EQ(MakeRecord(plan, split, {}, {}), record);
}

}  // namespace
}  // namespace lull

namespace lull::training_run_test {
namespace {

// Lets trainings continue for a number of steps, and counts their events.
struct Watcher {
    int left = 1 << 30, begun = 0, ended = 0;

    std::function<TrainingEvents(const BlockSplit&)> Events() {
        return [this](const BlockSplit&) {
            return TrainingEvents{
                .begin = [this](const TrainingSamples&, const TrainingProgress&) { ++begun; },
                .step = [this](const Trainer&) { --left; },
                .end = [this](const TrainingProgress&) { ++ended; },
                .isCancelled = [this] { return left <= 0; }};
        };
    }
};

TEST(TrainAll, ScoresEachNetworkByWhatItHasNotSeen) {
    const LearningData data;
    TrainingPlan plan = data.Plan();
    plan.crossValidate = true;
    const std::vector<BlockSplit> splits = MakeSplits(plan, data.Blocks());
    TrainingCheckpoint none("", 0, WriteBytes);
    Watcher watcher;
    const auto result = TrainAll(plan, splits, &none, watcher.Events());
    ASSERT_TRUE(result);
    EXPECT_EQ(watcher.begun, 3);
    EXPECT_EQ(watcher.ended, 3);
    // The recordings end at 1,200 spp, before all blocks have stopped.
    ASSERT_EQ(result->rules.size(), 4u);
    EXPECT_EQ(LabelOf(result->rules[0]), "each viewpoint left out, at least");
    EXPECT_EQ(LabelOf(result->rules[1]), "each viewpoint left out, extended");
    EXPECT_EQ(Score(result->rules[0].viewpoints, {}).open,
              Score(result->rules[1].viewpoints, {}).open);
    EXPECT_EQ(result->rules[0].viewpoints.size(), 2u);
    EXPECT_EQ(result->rules[0].viewpoints[1].name, "barn");
    EXPECT_EQ(result->rules[2].name, "blocks trained on");
    const auto record = MakeRecord(plan, splits.back(), *result, {});
    for (const char* figure : {"at least", "extended"})
        EXPECT_TRUE(record.at("judged on blocks trained on, " + std::string(figure))
                        .starts_with("critical error at 2 %: "));

    // One that leaves the same viewpoint out by name is the same network.
    plan.crossValidate = false;
    plan.leaveOut = {"attic"};
    const auto single = TrainAll(plan, MakeSplits(plan, data.Blocks()), &none, Watcher().Events());
    ASSERT_EQ(single->rules.size(), 2u);
    EXPECT_EQ(single->rules[0].name, "blocks left out");
    for (size_t i = 0; i < 4; ++i)
        EXPECT_EQ(single->rules[0].viewpoints[0].blocks[i].outcome.stop,
                  result->rules[0].viewpoints[0].blocks[i].outcome.stop);
}

TEST(TrainAll, GoesOnFromItsCheckpoint) {
    const LearningData data;
    TrainingPlan plan = data.Plan();
    plan.crossValidate = true;
    const std::vector<BlockSplit> splits = MakeSplits(plan, data.Blocks());
    TrainingCheckpoint none("", 0, WriteBytes);
    Watcher whole;
    const auto expected = TrainAll(plan, splits, &none, whole.Events());
    const int steps = (1 << 30) - whole.left;

    const ScratchFile file(".checkpoint");
    for (const int before : {0, steps / 2, steps - 1}) {
        Watcher first{before};
        TrainingCheckpoint checkpoint(file.path, 1e6, WriteBytes);
        EXPECT_FALSE(TrainAll(plan, splits, &checkpoint, first.Events()));
        EXPECT_EQ(first.begun, before == 0 ? 1 : first.begun);
        TrainingCheckpoint again(file.path, 1e6, WriteBytes);
        again.Read();
        Watcher rest;
        const auto result = TrainAll(plan, splits, &again, rest.Events());
        ASSERT_TRUE(result);
        EXPECT_EQ((1 << 30) - rest.left, steps - before);
        EXPECT_EQ(result->network.lstm[0].kernel, expected->network.lstm[0].kernel);
        again.Remove();
        EXPECT_FALSE(std::filesystem::exists(file.path));
    }
}

TEST(TrainingCheckpoint, IsOfOneTrainingAndWhole) {
    const LearningData data;
    TrainingPlan plan = data.Plan();
    const std::vector<BlockSplit> splits = MakeSplits(plan, data.Blocks());
    const ScratchFile file(".checkpoint");
    TrainingCheckpoint checkpoint(file.path, 1e6, WriteBytes);
    EXPECT_THROW(checkpoint.Read(), std::runtime_error);
    Watcher watcher{3};
    EXPECT_FALSE(TrainAll(plan, splits, &checkpoint, watcher.Events()));

    // Another training cannot go on from there.
    TrainingPlan other = plan;
    other.training.batch = 32;
    TrainingCheckpoint read(file.path, 1e6, WriteBytes);
    read.Read();
    EXPECT_THROW(TrainAll(other, splits, &read, Watcher().Events()), std::runtime_error);
    // Neither can this one from a part of the file.
    std::filesystem::resize_file(file.path, std::filesystem::file_size(file.path) - 1);
    TrainingCheckpoint cut(file.path, 1e6, WriteBytes);
    EXPECT_THROW(cut.Read(), std::runtime_error);

    TrainingCheckpoint full(file.path, 0, [](const std::string&, std::span<const std::byte>) {
        throw std::runtime_error("the disk is full");
    });
    EXPECT_THROW(TrainAll(plan, splits, &full, Watcher().Events()), std::runtime_error);
    TrainingCheckpoint nowhere("", 0,
                               [](const std::string&, std::span<const std::byte>) { FAIL(); });
    EXPECT_FALSE(nowhere.IsDue());
    nowhere.Write();
}

}  // namespace
}  // namespace lull::training_run_test
