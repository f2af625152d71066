// Reads and writes thresholds files, in the format in which the human thresholds are published.
#pragma once

#include <istream>
#include <string>
#include <vector>

#include "stopping/base/block_view.h"
#include "stopping/rules/rule.h"

namespace lull {

// The spp at which each block of a viewpoint needs no more samples, blocks row-major. The
// published files have 4 x 4 blocks and 10,000 where a block never stopped; any count is allowed.
struct ThresholdsRow {
    std::string name;      // of the viewpoint; not empty, without ';' and line breaks
    std::vector<int> spp;  // at least one, each >= 0
};

// Reads `name;t0;t1;...;` line by line; the last semicolon may be missing, empty lines are skipped.
// Throws std::runtime_error "file:line: ..." for anything else, or a name that comes twice.
std::vector<ThresholdsRow> ReadThresholds(const std::string& path);
std::vector<ThresholdsRow> ReadThresholds(std::istream& in, const std::string& fileName);

// Writes the rows so that ReadThresholds() returns them. Throws std::invalid_argument for a row
// that the format cannot hold and std::runtime_error if the file cannot be written.
void WriteThresholds(const std::string& path, const std::vector<ThresholdsRow>& rows);
void WriteThresholds(std::ostream& out, const std::vector<ThresholdsRow>& rows);

// Cuts pictures into the blocks that rules decide on, for all programs: the same picture has
// the same blocks, and so the same decisions, everywhere.

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

// Stops blocks where a row of a thresholds file says.

// Reads FILE or FILE:NAME.
Rule ReadThresholdsRule(const std::string& argument, const RuleContext& context);

}  // namespace lull
