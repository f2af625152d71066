#include "stopping/rules/block_grid.h"

#include <algorithm>
#include <cstdint>

namespace lull {

namespace {

bool IsSmall(const BlockRect& block, int smallestSide) {
    return std::min(block.width, block.height) < smallestSide;
}

// Returns the largest of the eight neighbours; -1 if there is none.
int LargestNeighbour(const BlockGrid& grid, int block) {
    const int rows = int(grid.blocks.size()) / grid.columns;
    const int x = block % grid.columns, y = block / grid.columns;
    int best = -1;
    int64_t bestArea = 0;
    for (int v = std::max(0, y - 1); v <= std::min(rows - 1, y + 1); ++v)
        for (int u = std::max(0, x - 1); u <= std::min(grid.columns - 1, x + 1); ++u) {
            const int i = v * grid.columns + u;
            const BlockRect& other = grid.blocks[size_t(i)];
            const int64_t area = int64_t(other.width) * other.height;
            if (i == block || area <= bestArea) continue;
            best = i;
            bestArea = area;
        }
    return best;
}

int LeaderOf(const BlockGrid& grid, int block, int smallestSide) {
    if (!IsSmall(grid.blocks[size_t(block)], smallestSide)) return block;
    const int leader = LargestNeighbour(grid, block);
    return leader >= 0 && IsSmall(grid.blocks[size_t(leader)], smallestSide) ? -1 : leader;
}

}  // namespace

BlockGrid CutIntoBlocks(int width, int height, int side, int smallestSide) {
    BlockGrid grid{.columns = (width + side - 1) / side};
    for (int y = 0; y < height; y += side)
        for (int x = 0; x < width; x += side)
            grid.blocks.push_back({x, y, std::min(side, width - x), std::min(side, height - y)});
    for (int i = 0; i < int(grid.blocks.size()); ++i)
        grid.leaders.push_back(LeaderOf(grid, i, smallestSide));
    return grid;
}

}  // namespace lull
