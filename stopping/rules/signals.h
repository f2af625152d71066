// Inputs of rules after a pass of a block, whether it was measured in a render or
// recorded.
#pragma once

#include <variant>
#include <vector>

#include "stopping/features/model_inputs.h"

namespace lull {

// A number for each pixel, row by row.
struct PixelErrors {
    int width = 0;
    std::vector<double> errors = {};
};

// Nothing but the spp; one number of the block; one of each pixel; inputs of networks.
using Signals = std::variant<std::monostate, double, PixelErrors, BlockMeasures>;

}  // namespace lull
