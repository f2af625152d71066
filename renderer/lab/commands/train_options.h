// The options of `lull train`.
#pragma once

#include <CLI/App.hpp>
#include <string>
#include <vector>

#include "renderer/files/outputs.h"
#include "renderer/progress/progress.h"
#include "stopping/lab/training/training_plan.h"

namespace lull::train {

struct TrainOptions {
    TrainingPlan plan;
    std::string output, csv;
    bool resume = false;
    double checkpointInterval = 60;  // s
    int threads = 0;
    bool quiet = false, jsonProgress = false;
    bool isPreset = false;     // --preset was given
    bool listsValues = false;  // and nothing is trained: its values are listed
};

void AddTrainOptions(CLI::App& app, TrainOptions* options);

// Returns the values of a plan as options of `lull train`, one a line.
std::string ValuesText(const TrainingPlan&);

// Returns the recordings and thresholds that a training reads; for CheckOutputs().
std::vector<NamedFile> InputsOf(const TrainingPlan&);

// Completes defaults that depend on other options. Throws CLI::ValidationError for contradictory
// options.
void CompleteTrainOptions(TrainOptions* options);

}  // namespace lull::train
