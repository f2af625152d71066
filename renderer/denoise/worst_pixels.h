// Finds the few pixels of a picture that are seen to be wrong most.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "renderer/vision/visible_difference.h"

namespace lull {

// Returns the pixels of a difference, one of 5,000, that are seen most; each counts by the visible
// difference there, which its neighbours have too, times its own difference in lightness.
std::vector<size_t> WorstPixels(const VisibleDifference&, std::span<const float> lightness);

}  // namespace lull
