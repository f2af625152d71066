// Draws how many samples each block had, in false colours.
#pragma once

#include <vector>

#include "renderer/film/film.h"

namespace lull {

struct SppBlock {
    PixelRect pixels;
    int spp;
    bool isNoisy = false;  // at the cap, where its rule has not stopped it
};

struct SppMap {
    int width = 0, height = 0;
    std::vector<uint8_t> srgb;  // R, G, B a pixel; row-major
};

// Returns the colour for t in [0, 1] (clamped) on a scale from dark blue to yellow that is
// ordered by lightness for every kind of colour vision (viridis), as sRGB values in [0, 1].
Rgb Viridis(float t);

// Draws the blocks of `region`, each with its spp if there is room for the number, a line between
// blocks, a red frame and a plus after the number where a block would have gone on, and below them
// a bar with the logarithmic scale from `lowest` to `highest` spp (0 < lowest <= highest).
SppMap DrawSppMap(const PixelRect& region, std::span<const SppBlock> blocks, int lowest,
                  int highest);

}  // namespace lull
