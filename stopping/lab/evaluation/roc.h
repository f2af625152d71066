// Measures how well numbers tell two classes apart.
#pragma once

#include <span>

namespace lull {

// Returns the area under the curve of the receiver operating characteristic: the probability that
// a sample with the label 1 has a higher score than one with 0; equal scores count one half. 0.5
// if there are no two classes. Throws std::invalid_argument if the lengths differ or a score is
// NaN.
double AreaUnderRoc(std::span<const float> scores, std::span<const char> labels);

}  // namespace lull
