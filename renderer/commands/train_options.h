// Says what `lull train` can be asked for.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "stopping/learning/training.h"

namespace lull {

struct TrainOptions {
    std::vector<std::string> datasets;
    std::string human, output, csv;
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

// Completes what depends on other options. Throws CLI::ValidationError for options that do not fit
// together.
void CompleteTrainOptions(TrainOptions* options);

}  // namespace lull
