// One sample count for all blocks of an image: the baseline of rules that measure blocks.
#pragma once

#include <span>
#include <vector>

#include "stopping/lab/evaluation/evaluation.h"
#include "stopping/lab/evaluation/rivals.h"

namespace lull {

// Returns up to three rules, of which every block of a viewpoint stops at one multiple of 20 spp
// (their setting): "constant, known", the best one on this viewpoint itself, which no rule can
// know; with two viewpoints or more "constant, of others", the best one on the others; and
// "constant", the best one on all. Only names and human thresholds are read of the outcomes. `grid`
// is the step of critical errors, in spp. Throws std::invalid_argument if there is no viewpoint.
std::vector<EvaluatedRule> EvaluateConstants(std::span<const ViewpointOutcome> viewpoints, ChooseBy,
                                             int grid);

}  // namespace lull
