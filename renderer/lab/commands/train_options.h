// Says what `lull train` can be asked for.
#pragma once

#include <CLI/App.hpp>
#include <span>
#include <string>
#include <vector>

#include "renderer/files/outputs.h"
#include "renderer/render/progress.h"
#include "stopping/lab/training/search_run.h"

namespace lull {

struct TrainOptions {
    TrainingPlan plan;
    std::string output, csv;
    std::string search;  // a grid of options to try; empty: none
    bool resume = false;
    double checkpointInterval = 60;  // s
    int threads = 0;
    bool quiet = false, jsonProgress = false;
};

void AddTrainOptions(CLI::App& app, TrainOptions* options);

// Sets options of the model and its training as `--name=value` would; any of them can be set.
// Throws std::invalid_argument saying what is wrong.
void SetPlanOptions(std::span<const OptionValue> values, TrainingPlan* plan);

// Returns the recordings and thresholds that a training reads; for CheckOutputs().
std::vector<NamedFile> InputsOf(const TrainingPlan&);

// Says how progress is to be shown.
ProgressStyle StyleOf(const TrainOptions& options);

// Completes what depends on other options. Throws CLI::ValidationError for options that do not fit
// together.
void CompleteTrainOptions(TrainOptions* options);

}  // namespace lull
