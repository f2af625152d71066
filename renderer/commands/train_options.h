// Says what `lull train` can be asked for.
#pragma once

#include <CLI/App.hpp>
#include <span>
#include <string>
#include <vector>

#include "renderer/output/progress.h"
#include "stopping/learning/training.h"

namespace lull {

struct TrainOptions {
    std::vector<std::string> datasets;
    std::string human, output, csv;
    std::string search;                          // a grid of options to try; empty: none
    std::string split;                           // a file of blocks to train on; empty: all
    std::vector<std::string> leaveOut, without;  // names of viewpoints
    bool crossValidate = false, resume = false;
    double checkpointInterval = 60;  // s
    ModelSettings settings;
    TrainingOptions training;
    int threads = 0;
    bool quiet = false, jsonProgress = false;
};

void AddTrainOptions(CLI::App& app, TrainOptions* options);

// Sets options of the model and its training as `--name=value` would; any of them can be set.
// Throws std::invalid_argument saying what is wrong.
struct OptionValue {
    std::string name, value;
};
void SetTrainOptions(std::span<const OptionValue> values, TrainOptions* options);

// Says how progress is to be shown.
ProgressStyle StyleOf(const TrainOptions& options);

// Completes what depends on other options. Throws CLI::ValidationError for options that do not fit
// together.
void CompleteTrainOptions(TrainOptions* options);

}  // namespace lull
