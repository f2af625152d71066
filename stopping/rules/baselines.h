// Provides the rules that compare a half of the samples, and fixed spp: those of other renderers,
// and lull's own.
//
// All error estimates compare the mean I of all samples with the mean A of one fixed half of
// them. With B the mean of the other half, I - A = (B - A) / 2; for independent samples it has
// the standard deviation sigma / sqrt(n), exactly the standard error of I. Below,
// d = |I_R - A_R| + |I_G - A_G| + |I_B - A_B| and s = I_R + I_G + I_B.
#pragma once

#include <span>

#include "stopping/rules/rule.h"

namespace lull {

// Stops blocks at `spp` samples per pixel, or the end of the pass that reaches it.
Rule FixedRule(int spp);

// Read the arguments of rules: N; T or T:area; T; T.
Rule ReadFixed(const std::string& argument, const RuleContext& context);
Rule ReadDammertz(const std::string& argument, const RuleContext& context);
Rule ReadCycles(const std::string& argument, const RuleContext& context);
Rule ReadLuxTile(const std::string& argument, const RuleContext& context);

// Returns the mean over the block of d / sqrt(s), where the term is 0 if s <= 0 (Dammertz,
// Hanika, Keller, Lensch: A Hierarchical Automatic Stopping Condition for Monte Carlo Global
// Illumination, WSCG 2010). It estimates the error in square-root brightness. Reads both means.
double DammertzError(const BlockView& view);

// Stops a block when DammertzError() < threshold, > 0, or, `byArea`, that times sqrt(block area /
// image area), as in the paper, whose recursive splitting so compares blocks of different sizes.
// Our blocks are not split: with it noise would be tolerated more in a larger image.
Rule DammertzRule(double threshold, bool byArea = false);

// Returns the error of a pixel as in Cycles' adaptive sampling: d / (0.0001 + g(s)), where g is
// the square root below 1 and the identity above. Both point to three components.
double CyclesPixelError(const float* mean, const float* halfMean);

// Returns Cycles' least number of samples at a threshold in (0, 1]: max(4, ceil(16 / T^0.3)).
int CyclesMinimumSpp(double threshold);

// Stops a block as Cycles stops an image: beyond the minimum, at every multiple of 20 spp, tests
// the active pixels (at first all). One is converged if its error is < 5 * threshold; the pixels
// around one that is not are active again (3 x 3 dilation, which makes a test of single pixels
// safe, as it has 75 % relative spread). The block stops when none is active. The decision's value
// is the largest error of the pixels tested / 5.
Rule CyclesRule(double threshold);

// Returns the pixel errors that it tests: CyclesPixelError() / 5.
PixelErrors CyclesErrors(const BlockView& view);

// Returns the largest difference, over pixels and components, between the display values of both
// means, clamp(x, 0, 1)^(1/2.2), as in LuxCore's tile test.
//
// LuxCore scales x by an exposure that it takes from the other tiles, in the order in which they
// were finished. The scale here is 1: blocks stay independent, and runs reproducible.
double LuxTileError(const BlockView& view);

// Stops a block when LuxTileError() < threshold, from 32 spp on. LuxCore tests every second pass,
// as its halves are the odd and the even passes; ours are balanced after every pass.
Rule LuxTileRule(double threshold);

// Stops blocks by the noise that an observer can see in their lightness.

// Returns the root mean square of one value or more: a block's RMS, from sub-blocks' of equal size.
double PooledRms(std::span<const float> subBlocks);

// Returns the RMS over the block of its noise in lightness, masked by texture: the pooled
// maskedNoise of 100 sub-blocks (lightness_noise.h). Reads both means. Throws as CheckView() does,
// and std::invalid_argument for a block of less than 10 pixels a side.
double VisibleNoise(const BlockView& view);

// Stops a block when VisibleNoise() was below `threshold`, > 0, after three passes in a row. The
// half-buffer estimate of a block varies by about 1 % where its noise is even, but more where a few
// pixels hold most of it: hence the votes.
Rule LightnessNoiseRule(double threshold);

inline constexpr const char* kLightnessNoiseName = "lnoise";

// Reads the threshold T, which the context's caution divides.
Rule ReadLightnessNoise(const std::string& argument, const RuleContext& context);

// Stops blocks by the difference that is still visible once they are denoised.

// The name under which a program supplies the measure: the visible difference between the block,
// denoised from nothing but its own samples, and the true one, as it is estimated.
inline constexpr const char* kDenoisedRuleName = "denoised";

// Reads the threshold T, which the context's caution divides. The block is checked first at 20
// spp and then wherever the spp have grown by a quarter, as denoising it takes as long as some
// samples, or sooner near T (Checks::growth); it stops as soon as the estimate is below T. Throws
// std::invalid_argument for a bad threshold, and where the program does not measure this.
Rule ReadDenoised(const std::string& argument, const RuleContext& context);

}  // namespace lull
