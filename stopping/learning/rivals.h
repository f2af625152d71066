// Gives each simple rule the best chance: its one setting is chosen on other viewpoints.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "stopping/learning/simulation.h"

namespace lull {

// Says what the best setting of a rule is: the one with the least mean error of the thresholds, or
// with the least critical error at 2 %.
enum class ChooseBy { AbsoluteError, CriticalError };

struct Rival {
    std::string rule;  // "dammertz", "cycles", "luxtile", "lnoise" or "entropy"
    // One for each viewpoint, with the setting that is the best one on all others.
    std::vector<ViewpointOutcome> viewpoints;
    double bestOfAll = 0;  // the best setting on all viewpoints: what to use on new ones
};

// Runs the rules dammertz, cycles, luxtile, lnoise and entropy over recorded blocks (those of one
// viewpoint follow each other), each viewpoint with the setting that does best on the others; of
// equally good ones the one that takes the fewest samples. Settings are kCyclesThresholds, else
// steps of 1 %. Throws std::invalid_argument if there are fewer than two viewpoints.
std::vector<Rival> JudgeRivals(std::span<const JudgedBlock> blocks, ChooseBy chooseBy, int grid);

}  // namespace lull
