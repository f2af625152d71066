// Judges rules on recordings that end too early: once at least, and once extended.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "stopping/lab/evaluation/evaluation.h"
#include "stopping/lab/recordings/training_samples.h"

namespace lull {

// Adds the outcome of a rule on `blocks`, whose recordings are unextended. Where it had not stopped
// all of them it is added twice, so that no figure looks final: stopped at their ends, and then the
// result of `extend`, its outcome on the same blocks with extended recordings. `extend` can be
// empty if no recording ends below kMostShownSpp.
void AddTwoFigures(std::span<const LabelledBlock> blocks, EvaluatedRule recorded,
                   const std::function<EvaluatedRule()>& extend, std::vector<EvaluatedRule>* rules);

}  // namespace lull
