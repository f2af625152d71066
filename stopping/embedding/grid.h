// Cuts a picture into blocks that are all large enough to be judged.
#pragma once

#include <vector>

#include "lull/stopping.h"

namespace lull {

// Holds the blocks row by row.
struct BlockGrid {
    int columns = 0;
    std::vector<lull_rect> blocks;
};

// Cuts width x height pixels into blocks of `side` pixels. What is left in a row or column is a
// block of its own, or is added to the previous one if it is below smallestVotingSide. All three
// are at least that.
BlockGrid CutIntoBlocks(int width, int height, int side);

}  // namespace lull
