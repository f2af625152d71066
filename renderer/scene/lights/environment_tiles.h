// Cuts an environment map into tiles, among which sampling can choose as it has learned to.
#pragma once

#include <cstdint>
#include <vector>

#include "renderer/base/block_distribution.h"
#include "renderer/base/tile_shares.h"

namespace lull {

// Divides the blocks of a map into bands and each band into tiles, of equal parts of power and
// solid angle, half of each. Within a tile blocks are chosen by their power.
class EnvironmentTiles {
  public:
    // Rows of the map are bands of equal height from theta = 0 to pi. The map must not be black,
    // and must outlive the tiles.
    explicit EnvironmentTiles(const BlockDistribution& map);

    // Returns a point of the unit square in the tile, by u in [0, 1)^2, and its density, given the
    // tile, whose power must be positive.
    Vec2f Sample(int tile, const Vec2f& u, float* pdf) const;
    // Returns that density at a point, and the tile that it lies in.
    float Pdf(const Vec2f& st, int* tile) const;

    // Sampling by power alone.
    const TileShares& Shares() const { return shares; }

  private:
    struct Tile {
        int16_t begin = 0, end = 0;  // columns of blocks
    };
    struct Band {
        int begin = 0, end = 0;  // rows of blocks
    };

    // Returns the running sums of the blocks in a column of a band.
    const float* RowSums(int band, int column) const {
        return &rowSums[size_t(bands[band].begin * counts.x()) +
                        size_t((bands[band].end - bands[band].begin) * column)];
    }

    const BlockDistribution* map;
    Vec2i counts;  // of blocks
    TileShares shares;
    std::vector<Tile> tiles;
    std::vector<Band> bands;
    std::vector<uint8_t> bandOf;   // by row of blocks
    std::vector<uint16_t> tileOf;  // by band and column of blocks
    // Running sums of probabilities, up to and with each, the last of which is 1: of the columns in
    // each tile, band after band, and of the blocks in each column of each band.
    std::vector<float> columnSums, rowSums;
};

}  // namespace lull
