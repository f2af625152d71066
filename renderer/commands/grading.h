// Shows the denoiser and the rules a render as graded pictures do.
#pragma once

#include <string>
#include <vector>

#include "renderer/denoise/grading.h"
#include "renderer/image/grade.h"
#include "stopping/rules/rule.h"

namespace lull {

// Returns the grades for the denoiser.
std::vector<Grading> GradingsOf(const std::vector<Grade>&);

// Returns them in words, with semicolons between them.
std::string NamesOf(const std::vector<Grade>&);

// Returns the maker of criteria that see blocks as the grades show them, unless the rule sees to
// that itself, or only counts.
CriterionMaker MakeGradedCriteria(const Rule&, const std::vector<Grade>&);

}  // namespace lull
