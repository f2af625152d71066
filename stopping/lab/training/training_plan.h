// The data and the options of a training, and of its evaluation.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stopping/lab/evaluation/evaluation.h"
#include "stopping/lab/recordings/labelled_blocks.h"
#include "stopping/lab/training/training.h"

namespace lull {

// Named ways to train a model: its features, its network, and the training of that.

struct TrainingPreset {
    std::string name;
    ModelSettings settings = {};
    TrainingOptions training = {};
};

// Returns the presets: "entropy", of the default model, and "paper", of Buisine et al. 2021.
std::span<const TrainingPreset> TrainingPresets();

struct TrainingPlan {
    std::vector<std::string> datasets;  // files of recordings
    std::string human;                  // the file of people's thresholds
    std::vector<std::string> without;   // viewpoints to ignore

    // Which networks are trained: one without each viewpoint in turn; and, as the last, one on all
    // blocks but those that are left out by name, or that the file `split` does not list.
    bool crossValidate = false, withLast = true;
    std::vector<std::string> together;  // beginnings of names; see LeaveEachOut()
    std::vector<std::string> leaveOut;  // viewpoints
    std::string split;                  // empty: none

    ModelSettings settings;
    TrainingOptions training;
    std::string version;  // of the program, for the record
};

// Returns a split for each network, in the order in which they are trained; the last split has no
// name. Throws std::runtime_error.
std::vector<BlockSplit> MakeSplits(const TrainingPlan& plan, std::span<const LabelledBlock> blocks);

// Throws std::runtime_error if n is no multiple of the recordings' pass.
void CheckSpacing(const ModelSettings& settings, int passSpp);

// Trains networks, one after the other, and judges them.

// Callbacks of a training, none for one that an earlier run has finished. None may be empty.
struct TrainingEvents {
    std::function<void(const TrainingSamples&, const TrainingProgress&)> begin;
    std::function<void(const Trainer&)> step;
    std::function<void(const TrainingProgress&)> end;
    std::function<bool()> isCancelled;  // is asked before each step; true ends the training
};

struct TrainingResult {
    Network network;  // the last one
    // Outcomes of networks: "each viewpoint left out" and, of the last one, "blocks left out" or,
    // if there are none, "blocks trained on"; each twice where recordings end too early for it, see
    // AddTwoFigures().
    std::vector<EvaluatedRule> rules = {};
};

// Trains and judges a network on each split of a plan. Nothing if it was cancelled: the checkpoint
// is written then. `eventsOf` is asked for the events of each training. Throws as MakeSamples(),
// Trainer and TrainingCheckpoint do.
std::optional<TrainingResult> TrainAll(
    const TrainingPlan& plan, std::span<const BlockSplit> splits, TrainingCheckpoint* checkpoint,
    const std::function<TrainingEvents(const BlockSplit&)>& eventsOf);

// Returns the training data of the last network, its options, and its evaluation; without the date,
// so that the same training gives the same text. Throws std::runtime_error if a file can no longer
// be read.
std::map<std::string, std::string> MakeRecord(const TrainingPlan& plan, const BlockSplit& split,
                                              const TrainingResult& result,
                                              const ScoreOptions& scoring);

}  // namespace lull
