// Stops blocks where a row of a thresholds file says.
#pragma once

#include "stopping/rules/criterion.h"

namespace lull {

// Reads FILE or FILE:NAME.
CriterionFactory ReadThresholdsRule(const std::string& argument, const RuleContext& context);

}  // namespace lull
