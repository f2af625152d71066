// Judges blocks by what noise adds to their SVD-entropy: lull's own rule with one number.
#pragma once

#include <span>

#include "stopping/rules/voting.h"
#include "stopping/signals/entropy_drop.h"

namespace lull {

// The sub-blocks that the rule looks at.
inline constexpr int kEntropySubBlocks = 100;

// Stops a block when the mean visible drop of its sub-blocks (see entropy_drop.h) was below
// `threshold`, > 0, at three looks in a row. It looks after the first pass and every 40 spp from
// then on, or every pass if passes are longer: what recordings have (see recording.h); with a
// passSpp of 0, at whatever comes 40 spp or more after its last look. The block needs at least
// 20 x 20 pixels.
VotingRule EntropyRule(double threshold, const NoiseVisibility& visibility, int passSpp);

// Reads the threshold T, which the context's caution divides.
CriterionFactory ReadEntropy(const std::string& argument, const RuleContext& context);

// Says at which spp the rule looks; passSpp > 0.
bool EntropyRuleLooks(int spp, int passSpp);

// Returns the number that is compared with the threshold.
double MeanVisible(std::span<const double> visibleDrops);

}  // namespace lull
