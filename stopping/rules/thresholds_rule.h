// Stops blocks where a row of a thresholds file says.
#pragma once

#include "stopping/rules/rule.h"

namespace lull {

// Reads FILE or FILE:NAME.
Rule ReadThresholdsRule(const std::string& argument, const RuleContext& context);

}  // namespace lull
