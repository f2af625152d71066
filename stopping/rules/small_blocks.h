// Lets blocks that are too small to be judged follow a neighbour.
#pragma once

#include <span>
#include <vector>

#include "stopping/base/block_view.h"

namespace lull {

struct BlockSize {
    int width = 0, height = 0;  // pixels, > 0
};

// Returns for each block of a row-major grid, `columns` wide, the block it follows: itself, if
// neither side is below `smallestSide`; else the largest of its eight neighbours, the first in
// row-major order among equals; -1 if that is too small as well, so that there is none to follow.
// Throws std::invalid_argument if the sizes do not fill whole rows.
std::vector<int> BlockLeaders(int columns, std::span<const BlockSize> sizes,
                              int smallestSide = smallestVotingSide);

// Returns the thresholds (spp) with each follower's replaced by its leader's; `cap` where there is
// none to follow. Throws std::invalid_argument if the lengths differ.
std::vector<int> FollowLeaders(std::span<const int> thresholds, std::span<const int> leaders,
                               int cap);

}  // namespace lull
