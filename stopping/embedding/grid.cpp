#include "stopping/embedding/grid.h"

#include "stopping/base/block_view.h"

namespace lull {

namespace {

struct Piece {
    int begin, length;
};

std::vector<Piece> Cut(int length, int side) {
    std::vector<Piece> pieces;
    for (int begin = 0; begin < length;) {
        const int rest = length - begin;
        pieces.push_back({begin, rest < side + smallestVotingSide ? rest : side});
        begin += pieces.back().length;
    }
    return pieces;
}

}  // namespace

BlockGrid CutIntoBlocks(int width, int height, int side) {
    const std::vector<Piece> columns = Cut(width, side);
    BlockGrid grid{.columns = int(columns.size()), .blocks = {}};
    for (const Piece& row : Cut(height, side))
        for (const Piece& column : columns)
            grid.blocks.push_back({column.begin, row.begin, column.length, row.length});
    return grid;
}

}  // namespace lull
