// Trains and judges all combinations of a search.
#pragma once

#include <functional>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "stopping/lab/recordings/judged_blocks.h"
#include "stopping/lab/training/search.h"
#include "stopping/lab/training/training_run.h"

namespace lull {

// Holds the name of an option, without its dashes, and the text of its value.
struct OptionValue {
    std::string name, value;
};

// Sets options of a plan's model and training; throws std::invalid_argument saying what is wrong.
using OptionSetter = std::function<void(std::span<const OptionValue>, TrainingPlan*)>;

// Holds a combination that is ready to be trained.
struct Trial {
    std::vector<std::string> values;  // of the axes
    std::string name;                 // "k 4, features H"
    TrainingPlan plan;
    std::vector<BlockSplit> splits;
};

// Makes all combinations that the axes, from the file `grid`, make of a plan, and finds out now
// whether one of them cannot be trained. All are trained and judged on the same blocks, or their
// figures could not be compared. Throws std::runtime_error beginning with file and line or the
// name of the combination.
std::vector<Trial> MakeTrials(const TrainingPlan& plan, const std::string& grid,
                              std::span<const SearchAxis> axes,
                              const std::vector<JudgedBlock>& judged, const OptionSetter& set,
                              const WarningSink& warn);

// Checks each value by itself, so that an error can name its line. Throws std::runtime_error.
void CheckGrid(const TrainingPlan& plan, const std::string& grid, std::span<const SearchAxis> axes,
               const OptionSetter& set);

// Says what everything is learned from, and with which options that no axis may change: results of
// another search cannot be among those of this one.
std::string SearchDataText(const TrainingPlan& plan, const Trial& first);

// Says how far a search is.
struct SearchProgress {
    const Trial& trial;               // the one under way
    std::span<const double> seconds;  // that each one before has taken
    size_t trained;                   // how many of the trial's networks are done
    const Trainer& trainer;           // of the next one
    double now;                       // seconds since the trial began

    // Returns what share of the trial is done, in [0, 1].
    double Share() const;
};

// Is told of a search. None may be empty.
struct SearchEvents {
    std::function<void(const SearchProgress&)> step;  // after each step of a training
    // After each combination and when the search is cancelled: the results so far.
    std::function<void(const std::vector<SearchResult>&)> keep;
    WarningSink warn;
    std::function<bool()> isCancelled;  // is asked before each step of a training
};

struct SearchOutcome {
    std::vector<SearchResult> results;  // in the order of the trials
    bool cancelled = false;  // before all were done; the checkpoint has the one under way
};

// Trains and judges the trials, but those that are in `known` already. What cannot be trained has
// results that are NaN, and a warning. Throws what the events throw, and CheckpointError.
SearchOutcome RunTrials(std::span<const Trial> trials, std::span<const SearchResult> known,
                        TrainingCheckpoint* checkpoint, const SearchEvents& events);

}  // namespace lull
