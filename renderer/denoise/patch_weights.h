// Says how alike the surroundings of pixels are: the weights of non-local means (Buades, Coll and
// Morel 2005), with the noise of each pixel taken into account (Rousselle, Knaus and Zwicker 2012).
#pragma once

#include <vector>

#include "renderer/denoise/tile.h"

namespace lull {

// Holds an image that pixels are compared by, and the variance of each of its values.
struct PatchGuide {
    const Planes& image;
    const Planes& variance;
};

struct PatchOptions {
    int radius = 9;       // pixels up to so far apart are compared, on either axis
    int patchRadius = 3;  // by the (2 patchRadius + 1)^2 pixels around them
};

// Measures, for a tile and what lies around it, how far the patches of two pixels are apart: the
// mean over patch and channels of (u - u')^2 / (v + v') - 1, which is 0 on average where noise is
// all that differs.
class PatchWeights {
  public:
    struct Offset {
        int x, y;
    };

    // Pixels up to `margin` outside of the tile can be asked for.
    PatchWeights(const PatchGuide&, const ImageTile&, int margin, const PatchOptions&);

    // The offsets of a window, row by row.
    const std::vector<Offset>& Offsets() const { return offsets; }

    // Returns exp(-d / bandwidth^2), with d the distance and not below 0, of the pixels (x, y) to
    // (x + 15, y) and those at offset number o from them; 0 where these lie beyond the image.
    Lanes Of(int o, int x, int y, float bandwidth) const {
        const auto [dx, dy] = offsets[size_t(o)];
        const LanesIn there(inside.At(0, x + dx, y + dy));
        if (o == halfCount) return there;
        const LanesIn d(o < halfCount ? distances.At(o, x, y)
                                      : distances.At(2 * halfCount - o, x + dx, y + dy));
        return (d * (-1 / (bandwidth * bandwidth))).exp() * there;
    }

  private:
    void Measure(const Cutout& guide, const Cutout& variance, int patchRadius, int o);

    std::vector<Offset> offsets;
    int halfCount;     // of the offsets before the one in the middle; number i and
                       // 2 halfCount - i are opposite, and have the same distances
    Cutout distances;  // one channel for each offset of the first half
    Cutout inside;     // 1 within the image, 0 outside
};

}  // namespace lull
