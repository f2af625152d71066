// Samples the unit square by a large table, of which little has to be in the caches.
#pragma once

#include <functional>

#include "renderer/base/sampling.h"

namespace lull {

// Represents a density over the unit square that is constant over each of columns x rows cells.
// Blocks of cells are chosen by a small table. Where the weights of a block's cells differ, so that
// it matters, the block has a table of its cells; else it is sampled evenly.
class BlockDistribution {
  public:
    static constexpr int kSide = 16;  // of a block, in cells

    // Writes the weights of a row of cells, >= 0, whose sum is finite. Called again for some rows.
    using Weigh = std::function<void(int row, std::span<float> weights)>;

    BlockDistribution() = default;
    // The density is proportional to the weights, but for blocks that are sampled evenly. These
    // add at most `tolerance` to the relative variance of weight / density: with 0 it is exact.
    BlockDistribution(int columns, int rows, const Weigh& weigh, float tolerance);

    // Returns a point of the unit square, and the density there: 0 if all weights are 0.
    Vec2f Sample(const Vec2f& u, float* pdf) const {
        Vec2f place = u;
        float pmf;
        const Vec2i block = blocks.SampleDiscrete(&place, &pmf);
        *pdf = scale;
        Vec2f cell = kSide * (block.cast<float>() + place);
        if (const int32_t table = TableOf(block); table >= 0) {
            const Cells& in = cells[table];
            const int row = Choose(in.rows, &place.y(), pdf);
            const int column = Choose(in.columns[row], &place.x(), pdf);
            *pdf *= kSide * kSide;
            cell = (kSide * block + Vec2i(column, row)).cast<float>() + place;
        }
        *pdf *= pmf;
        return {std::min(cell.x() / float(columns), kOneMinusEpsilon),
                std::min(cell.y() / float(rows), kOneMinusEpsilon)};
    }
    // Returns the density at a point of the unit square.
    float Pdf(const Vec2f& st) const {
        const int column = std::clamp(int(st.x() * float(columns)), 0, columns - 1);
        const int row = std::clamp(int(st.y() * float(rows)), 0, rows - 1);
        const Vec2i block(column / kSide, row / kSide);
        const int32_t table = TableOf(block);
        if (table < 0) return scale * blocks.Pmf(block);
        const Cells& in = cells[table];
        return scale * (kSide * kSide) * Pmf(in.rows, row % kSide) *
               Pmf(in.columns[row % kSide], column % kSide) * blocks.Pmf(block);
    }

  private:
    // Running sums of probabilities, up to and with each element; the last is 1.
    using Sums = std::array<float, kSide>;

    // The rows of a block, and the cells of each row: two cache lines are read.
    struct alignas(64) Cells {
        Sums rows;
        std::array<Sums, kSide> columns;
    };

    int32_t TableOf(const Vec2i& block) const {
        return tables[size_t(block.y()) * size_t(blocks.Columns()) + block.x()];
    }
    static float Pmf(const Sums& sums, int i) { return i == 0 ? sums[0] : sums[i] - sums[i - 1]; }
    // Chooses an element; `u` in [0, 1) becomes the place in it, and `pmf` is multiplied by its
    // probability.
    static int Choose(const Sums& sums, float* u, float* pmf) {
        int i = 0;
        for (int k = 0; k < kSide - 1; ++k) i += sums[k] <= *u;
        const float below = i == 0 ? 0 : sums[i - 1];
        const float width = sums[i] - below;
        *u = std::min((*u - below) / width, kOneMinusEpsilon);
        *pmf *= width;
        return i;
    }
    static Sums SumsOf(const Sums& weights);
    static Cells MakeCells(const float* weights, int stride);

    int columns = 1, rows = 1;  // without the padding of the last blocks
    float scale = 0;            // density of a block that is as likely as all together
    Distribution2D blocks;
    std::vector<int32_t> tables;  // by block, row by row; -1: sampled evenly
    std::vector<Cells> cells;
};

}  // namespace lull
