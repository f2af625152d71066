// Draws how the numbers of stopping rules fall with the samples of each block, beside where people
// ceased to see noise (the paper's Fig. 13, svd_entropy.h).
#pragma once

#include <string>
#include <vector>

#include "stopping/lab/evaluation/evaluation.h"

namespace lull {

// Curves and stops of a rule on the blocks of a viewpoint.
struct CurvesOfRule {
    std::string name;
    // Threshold of the number, > 0; 0: the rule has no number, and only stops are drawn.
    double threshold = 0;
    const ViewpointOutcome* outcome = nullptr;
};

// Returns an SVG with a panel for each block: the number of each rule over twice its threshold, so
// that a probability of noise is drawn as it is and all rules vote to stop below 0.5, against the
// spp (logarithmic); a dot where the rule stopped the block, and a dashed line at the human
// threshold. All rules have the same blocks, at least one.
std::string CurvesSvg(const std::string& viewpoint, const std::vector<CurvesOfRule>& rules);

// Returns a CSV file of all verdicts, with a line of names: rule,viewpoint,block,human,stop,spp,
// value,threshold,noisy. Rules without a number, and spp at which there is none, are left out.
std::string CurvesCsv(const std::vector<CurvesOfRule>& rules);

}  // namespace lull
