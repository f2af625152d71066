// Cuts pictures into the blocks that rules decide on, for all programs: the same picture has
// the same blocks, and so the same decisions, everywhere.
#pragma once

#include <vector>

#include "stopping/base/block_view.h"

namespace lull {

struct BlockRect {
    int x = 0, y = 0, width = 0, height = 0;  // pixels; x to the right, y down

    bool operator==(const BlockRect&) const = default;
};

// The blocks of a picture, row by row.
struct BlockGrid {
    int columns = 0;
    std::vector<BlockRect> blocks = {};
    // Of each block the one that it stops with: itself, if it is large enough to be checked; else
    // the largest of its eight neighbours, the first in row-major order among equals; -1 if that is
    // too small as well, so that there is none to follow.
    std::vector<int> leaders = {};
};

// Cuts width x height pixels, none if one of them is 0, into blocks of `side` > 0 pixels; the
// remainder at the right and at the bottom makes smaller ones. Those with a side below
// `smallestSide` are not checked.
BlockGrid CutIntoBlocks(int width, int height, int side, int smallestSide = kSmallestVotingSide);

}  // namespace lull
