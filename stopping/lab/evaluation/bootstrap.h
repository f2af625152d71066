// Estimates the uncertainty of a mean over viewpoints by resampling viewpoints and blocks.
#pragma once

#include <span>
#include <vector>

namespace lull {

struct Interval {
    double low = 0, high = 0;
};

// Returns the range of the central 95 % of the mean over viewpoints of the means over their blocks,
// where both are drawn again with replacement (Efron's bootstrap, percentiles of 2,000 draws with a
// fixed seed); where there is one viewpoint, blocks alone. `values` has the blocks of each
// viewpoint; every viewpoint has a block. With few viewpoints it is too narrow. Throws
// std::invalid_argument if there is no viewpoint or one has no block.
Interval BootstrapInterval(std::span<const std::vector<double>> values);

}  // namespace lull
