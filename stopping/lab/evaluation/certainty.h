// Finds out how far people's thresholds lie from where a rule stops blocks that it had not seen.
#pragma once

#include <span>
#include <vector>

#include "stopping/lab/evaluation/evaluation.h"

namespace lull {

// Returns kLogRatios quantiles of log(T / S), of the thresholds T of people and the stops S, each
// viewpoint counting the same. Thresholds at the cap stand for all that are larger, and so does the
// end of a recording for stops beyond it. Throws std::invalid_argument if there is no block.
std::vector<double> LogRatioQuantiles(std::span<const ViewpointOutcome> viewpoints);

// Returns the fraction of thresholds in the range that the other viewpoints give for the rule's
// stop, averaged over the viewpoints: ideally 0.8. Throws std::invalid_argument if there are fewer
// than two viewpoints.
double RangeCoverage(std::span<const ViewpointOutcome> viewpoints);

}  // namespace lull
