// The probabilities of the tiles of an environment map (environment_tiles.h), in 16 bits.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "renderer/base/math.h"

namespace lull {

// Running sums of the probabilities of bands, one above the other, and of the tiles in each band
// from left to right. A choice reads two cache lines, and neighbouring numbers choose neighbouring
// tiles, so that samples stay stratified.
struct alignas(64) TileShares {
    static constexpr int kBands = 8, kColumns = 16, kCount = kBands * kColumns;
    static constexpr int kWhole = 65535;

    TileShares() = default;
    // `weights`: kCount finite numbers >= 0, band after band. A tile whose weight is positive has
    // at least 1 / kWhole of its band, and so has the band of all; others have none, unless all
    // weights are 0: then the first tile has it all.
    explicit TileShares(std::span<const float> weights);

    // Chooses a tile by u in [0, 1)^2, which is stretched over the choice.
    int Choose(Vec2f* u) const {
        const int band = ChooseFrom(bands, &u->y());
        return band * kColumns + ChooseFrom(columns[size_t(band)], &u->x());
    }
    // Returns the probability of the tile.
    float Probability(int tile) const {
        const int band = tile / kColumns;
        return Width(bands, band) * Width(columns[size_t(band)], tile % kColumns) *
               (1.f / (float(kWhole) * float(kWhole)));
    }

    std::array<uint16_t, kBands> bands = {};  // the last one kWhole
    std::array<std::array<uint16_t, kColumns>, kBands> columns = {};

  private:
    template <size_t N>
    static float Width(const std::array<uint16_t, N>& sums, int i) {
        return float(sums[size_t(i)] - (i > 0 ? sums[size_t(i) - 1] : 0));
    }
    template <size_t N>
    static int ChooseFrom(const std::array<uint16_t, N>& sums, float* u) {
        const float x = *u * float(kWhole);
        const auto whole = uint16_t(x);
        int i = 0;
        for (const uint16_t s : sums) i += s <= whole;
        const float before = i > 0 ? float(sums[size_t(i) - 1]) : 0;
        *u = std::min((x - before) / Width(sums, i), kOneMinusEpsilon);
        return i;
    }
};

// Returns whether the sums are those of probabilities, as read from a file.
bool IsValid(const TileShares&);

}  // namespace lull
