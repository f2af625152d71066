// Measures whether borders of blocks are visible: the noise level jumps where blocks stop at
// different spp.
#pragma once

#include <span>
#include <vector>

#include "renderer/film/film.h"

namespace lull {

// Mean jumps of the noise level: the difference of the root mean squares of the noise in the
// 10 pixels to either side of a line, over 20 pixels of its length. Where the noise is even, only
// the spread of the estimate remains; `inside` says how much that and the picture itself
// contribute.
struct Seams {
    double border = 0;  // across the borders between blocks
    double inside = 0;  // across the middle lines of the blocks, both ways
    // 1: borders are like the rest of the image; NaN where there is no border or no noise.
    double Ratio() const;
};

// Measures an image's noise: a signed value per pixel, such as the error of the lightness,
// row-major. Blocks are in pixels from the image's upper left corner. Lines less than 10 pixels
// from the next one are left out.
Seams MeasureSeams(std::span<const float> noise, int width, std::span<const PixelRect> blocks);

}  // namespace lull
