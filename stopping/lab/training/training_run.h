// Trains networks, one after the other, and judges them.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "stopping/lab/evaluation/evaluation.h"
#include "stopping/lab/training/training_checkpoint.h"
#include "stopping/lab/training/training_plan.h"

namespace lull {

// Callbacks of a training, none for one that an earlier run has finished. None may be empty.
struct TrainingEvents {
    std::function<void(const TrainingSamples&, const TrainingProgress&)> begin;
    std::function<void(const Trainer&)> step;
    std::function<void(const TrainingProgress&)> end;
    std::function<bool()> isCancelled;  // is asked before each step; true ends the training
};

// Result of a plan.
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

// Returns the training data of the last network, its options, and its evaluation.
std::map<std::string, std::string> MakeRecord(const TrainingPlan& plan, const BlockSplit& split,
                                              const TrainingResult& result,
                                              const ScoreOptions& scoring);

}  // namespace lull
