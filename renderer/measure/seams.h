// Measures whether the borders of blocks can be seen: where blocks stop at different spp, the level
// of the noise jumps.
#pragma once

#include <span>
#include <vector>

#include "renderer/output/film.h"

namespace lull {

// Holds mean jumps of the noise level: the difference of the root mean squares of the noise in the
// 10 pixels to either side of a line, over 20 pixels of its length. Where the noise is even, what
// is left is the spread of the estimate; `inside` says how much that and the picture itself make.
struct Seams {
    double border = 0;  // across the borders between blocks
    double inside = 0;  // across the middle lines of the blocks, both ways
    // 1: borders are like the rest of the image; NaN where there is no border or no noise.
    double Ratio() const;
};

// Measures an image's noise: a value a pixel with its sign, such as the error of the lightness,
// row-major. Blocks are in pixels from the image's upper left corner. Lines that are nearer than 10
// pixels to the next are left out.
Seams MeasureSeams(std::span<const float> noise, int width, std::span<const PixelRect> blocks);

}  // namespace lull
