// Computes the similarity of the neighbourhoods of pixels: the weights of non-local means (Buades,
// Coll and Morel 2005), corrected for the noise of each pixel (Rousselle, Knaus and Zwicker 2012).
#pragma once

#include <vector>

#include "renderer/denoise/tile.h"

namespace lull {

// Image by which pixels are compared, and the variance of each of its values.
struct PatchGuide {
    const Planes& image;
    const Planes& variance;
};

struct PatchOptions {
    int radius = 9;       // pixels up to so far apart are compared, on either axis
    int patchRadius = 3;  // by the (2 patchRadius + 1)^2 pixels around them
};

// Measures, row by row of a tile and its border, the distance of the patches of two pixels: the
// mean over patch and channels of (u - u')^2 / (v + v') - 1, which is 0 on average for patches that
// differ by noise only. Where one of them has far more noise, v + v' is limited. Only the rows are
// stored that the current one is compared with.
class PatchWeights {
  public:
    struct Offset {
        int x, y;
    };

    // Pixels up to `margin` outside of the tile can be asked for.
    PatchWeights(const PatchGuide&, const ImageTile&, int margin, const PatchOptions&);

    // The offsets of a window, row by row.
    const std::vector<Offset>& Offsets() const { return offsets; }

    // Makes y the row that is asked for. Rows come from top to bottom; some may be left out.
    void MoveTo(int y);

    // Returns the distances, not below 0, of the pixels (x, row) to (x + 15, row) from those at
    // offset number o; where these lie beyond the image, so large a number that nothing is left.
    Lanes Distances(int o, int x) const {
        const auto [dx, dy] = offsets[size_t(o)];
        if (row + dy < 0 || row + dy >= imageHeight) return Lanes::Constant(kBeyond);
        const LanesIn there(&beyond[size_t(x + dx - area.x0)]);
        if (o == halfCount) return there;
        const LanesIn d(o < halfCount ? DistancesAt(o, x, row)
                                      : DistancesAt(2 * halfCount - o, x + dx, row + dy));
        return d + there;
    }

    static Lanes WeightOf(const Lanes& distances, float bandwidth) {
        return (distances * (-1 / (bandwidth * bandwidth))).exp();
    }

  private:
    static constexpr float kBeyond = 1e6f;

    const float* DistancesAt(int o, int x, int y) const {
        return &distances[RingRow(o, y, distanceRows) + size_t(x - area.x0)];
    }
    // Returns where row y of offset number o begins in a ring that keeps the last `rows` of each.
    size_t RingRow(int o, int y, int rows) const {
        return size_t(o * rows + (y - area.y0) % rows) * stride;
    }
    void AddRow(int y);
    void MeasureRow(int y);

    std::vector<Offset> offsets;
    int halfCount;  // of the offsets before the one in the middle; number i and
                    // 2 halfCount - i are opposite, and have the same distances
    int radius, patchRadius, imageHeight;
    ImageTile area;
    Cutout image, variance;
    size_t stride;                         // of a row of the buffers below; the first is at area.x0
    std::vector<float> beyond;             // 0 at columns within the image, kBeyond outside
    int distanceRows, sumRows;             // that the rings have
    std::vector<float> distances;          // of the first half of the offsets
    std::vector<float> sums;               // of differences along the rows of patches
    std::vector<float> differences;        // of the row at hand
    int row = 0, nextSums, nextDistances;  // rows still to be made
};

}  // namespace lull
