// Prints a comparison for people.
#pragma once

#include "renderer/lab/pages/comparison_page.h"

namespace lull {

// Returns the figures of the images, a line an image, and below them the savings.
std::string ComparisonTable(const ComparisonReport&);

}  // namespace lull
