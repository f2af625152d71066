// The data and the options of a training, and of its evaluation.
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "stopping/lab/recordings/block_split.h"
#include "stopping/lab/training/training.h"

namespace lull {

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

// Throws std::runtime_error if n or the spacing of votes is no multiple of the recordings' pass.
void CheckSpacing(const ModelSettings& settings, int passSpp);

// Returns the training data and options of a network; without the date, so that the same training
// gives the same text. Throws std::runtime_error if a file can no longer be read.
std::map<std::string, std::string> MakeRecord(const TrainingPlan& plan, const BlockSplit& split);

}  // namespace lull
