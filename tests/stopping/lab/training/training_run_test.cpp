#include "stopping/lab/training/training_run.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <stdexcept>

#include "tests/stopping/lab/training/learning_data.h"

namespace lull::training_run_test {
namespace {

void WriteFile(const std::string& path, std::span<const std::byte> bytes) {
    std::ofstream(path, std::ios::binary)
        .write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
}

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
    TrainingCheckpoint none("", 0, WriteFile);
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
    TrainingCheckpoint none("", 0, WriteFile);
    Watcher whole;
    const auto expected = TrainAll(plan, splits, &none, whole.Events());
    const int steps = (1 << 30) - whole.left;

    const ScratchFile file(".checkpoint");
    for (const int before : {0, steps / 2, steps - 1}) {
        Watcher first{before};
        TrainingCheckpoint checkpoint(file.path, 1e6, WriteFile);
        EXPECT_FALSE(TrainAll(plan, splits, &checkpoint, first.Events()));
        EXPECT_EQ(first.begun, before == 0 ? 1 : first.begun);
        TrainingCheckpoint again(file.path, 1e6, WriteFile);
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
    TrainingCheckpoint checkpoint(file.path, 1e6, WriteFile);
    EXPECT_THROW(checkpoint.Read(), std::runtime_error);
    Watcher watcher{3};
    EXPECT_FALSE(TrainAll(plan, splits, &checkpoint, watcher.Events()));

    // Another training cannot go on from there.
    TrainingPlan other = plan;
    other.training.batch = 32;
    TrainingCheckpoint read(file.path, 1e6, WriteFile);
    read.Read();
    EXPECT_THROW(TrainAll(other, splits, &read, Watcher().Events()), std::runtime_error);
    // Neither can this one from a part of the file.
    std::filesystem::resize_file(file.path, std::filesystem::file_size(file.path) - 1);
    TrainingCheckpoint cut(file.path, 1e6, WriteFile);
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
