// Stops blocks by the noise that an observer can see in their lightness.
#pragma once

#include <span>

#include "stopping/rules/rule.h"

namespace lull {

// Returns the root of the mean of squares: the RMS of a block, from the RMS of sub-blocks that are
// equally large. At least one value.
double PooledRms(std::span<const float> subBlocks);

// Returns the RMS over the block of its noise in lightness, masked by texture: the pooled
// maskedNoise of 100 sub-blocks (lightness_noise.h). Reads both means. Throws as CheckView() does,
// and std::invalid_argument for a block of less than 10 pixels a side.
double VisibleNoise(const BlockView& view);

// Stops a block when VisibleNoise() was below `threshold`, > 0, after three passes in a row. The
// half-buffer estimate of a block varies by about 1 % where its noise is even, but more where a few
// pixels hold most of it: hence the votes.
Rule LightnessNoiseRule(double threshold);

// The name of the rule.
inline constexpr const char* kLightnessNoiseName = "lnoise";

// Reads the threshold T, which the context's caution divides.
Rule ReadLightnessNoise(const std::string& argument, const RuleContext& context);

// Stops blocks by the difference that is still visible once they are denoised.

// The name under which a program supplies the measure: the visible difference between the block,
// denoised from nothing but its own samples, and the true one, as it is estimated.
inline constexpr const char* kDenoisedRuleName = "denoised";

// Reads the threshold T, which the context's caution divides. The block is checked first at 20
// spp and then wherever the spp have grown by a quarter, as denoising it takes as long as some
// samples; it stops as soon as the estimate is below T. Throws std::invalid_argument
// for a bad threshold, and where the program does not measure this.
Rule ReadDenoised(const std::string& argument, const RuleContext& context);

}  // namespace lull
