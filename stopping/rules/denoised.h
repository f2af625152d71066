// Stops blocks by the difference that is still visible once they are denoised.
#pragma once

#include "stopping/rules/rule.h"

namespace lull {

// The name under which a program supplies the measure: the visible difference between the block,
// denoised from nothing but its own samples, and the true one, as a bound that is seldom exceeded.
inline constexpr const char* kDenoisedRuleName = "denoised";

// Reads the threshold T, which the context's caution divides. The block is checked first at 20
// spp and then wherever the spp have grown by a quarter, as denoising it takes as long as some
// samples; it stops as soon as the bound is below T. Throws std::invalid_argument
// for a bad threshold, and where the program does not measure this.
Rule ReadDenoised(const std::string& argument, const RuleContext& context);

}  // namespace lull
