// Gives each simple rule the best chance: its setting is chosen on other viewpoints.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "stopping/lab/evaluation/evaluation.h"
#include "stopping/lab/evaluation/simulation.h"

namespace lull {

// Criterion for the best setting of a rule: the least mean error of the thresholds, or the least
// critical error at 2 %.
enum class ChooseBy { AbsoluteError, CriticalError };

// Returns that error of a viewpoint, in spp or a share in [0, 1]. `grid` is the step of critical
// errors, in spp.
double CostOf(const ViewpointOutcome& viewpoint, ChooseBy, int grid);

// Runs the rules over recorded blocks (grouped by viewpoint), each viewpoint
// with the setting that does best on the others; of equally good ones the one that takes the fewest
// samples. A rule has the best setting on all viewpoints, for use on new ones: a threshold, to
// three digits. Thresholds are RecordedRule's. Rules that compare halves are left out where a block
// was recorded without (HasHalves()). Throws std::invalid_argument if there are fewer than two
// viewpoints.
std::vector<EvaluatedRule> EvaluateRivals(std::span<const LabelledBlock> blocks, ChooseBy chooseBy,
                                          int grid);

// One sample count for all blocks of an image: the baseline of rules that measure blocks.

// Returns up to three rules, of which every block of a viewpoint stops at one multiple of 20 spp
// (their setting): "constant, known", the best one on this viewpoint itself, which no rule can
// know; with two viewpoints or more "constant, of others", the best one on the others; and
// "constant", the best one on all. Only names and human thresholds are read of the outcomes. `grid`
// is the step of critical errors, in spp. Throws std::invalid_argument if there is no viewpoint.
std::vector<EvaluatedRule> EvaluateConstants(std::span<const ViewpointOutcome> viewpoints, ChooseBy,
                                             int grid);

}  // namespace lull
