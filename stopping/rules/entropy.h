// Stops blocks by the noise in their SVD-entropy: lull's own rule with one number.
#pragma once

#include <span>

#include "stopping/rules/rule.h"
#include "stopping/signals/entropy_drop.h"

namespace lull {

// The sub-blocks that the rule looks at.
inline constexpr int kEntropySubBlocks = 100;

// Stops a block when the mean visible drop of its sub-blocks (see entropy_drop.h) was below
// `threshold`, > 0, at three checks in a row. The block needs at least 20 x 20 pixels.
Rule EntropyRule(double threshold, const NoiseVisibility& visibility, int passSpp);

// Reads the threshold T, which the context's caution divides.
Rule ReadEntropy(const std::string& argument, const RuleContext& context);

// Returns its checks: after the first pass and every 40 spp from then on, or every pass if passes
// are longer, as in recordings (see recording.h); with a passSpp of 0, at the first picture 40 spp
// or more after the last check.
Checks EntropyChecks(int passSpp);

// Returns the number that is compared with the threshold.
double MeanVisible(std::span<const double> visibleDrops);

}  // namespace lull
