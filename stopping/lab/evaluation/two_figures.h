// Judges rules on recordings that end too early: once at least, and once extended.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "stopping/lab/evaluation/evaluation.h"
#include "stopping/lab/recordings/training_samples.h"

namespace lull {

// Adds what a rule did to `blocks`, whose recordings are as they are. Where it had not stopped all
// of them it is added twice, so that no figure looks final: stopped at their ends, and then what
// `extend` returns, which is what it did to the same blocks with extended recordings. `extend` can
// be empty if no recording ends below kJudgedCap.
void AddTwoFigures(std::span<const LabelledBlock> blocks, EvaluatedRule recorded,
                   const std::function<EvaluatedRule()>& extend, std::vector<EvaluatedRule>* rules);

}  // namespace lull
