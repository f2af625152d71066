// Compares guided samples with unguided ones: how noisy they are, and how long their paths.
#pragma once

#include <array>
#include <vector>

#include "renderer/film/film.h"

namespace lull {

// Sums up samples of a tile.
struct SampleSpread {
    double squares = 0;    // of luminance, about the means of its pixels
    int64_t freedom = 0;   // how many of these are independent
    int64_t vertices = 0;  // of paths, beside the camera
    int64_t samples = 0;
};

// Holds what guided samples are over unguided ones.
struct GuideComparison {
    double variance = 1;  // of a sample: the square of the ratio of noise, see below
    double error = 0;     // standard error of that
    double vertices = 1;  // of a path
};

// Samples of both kinds, tile by tile, as the film has tiles.
struct GuideTally {
    std::vector<SampleSpread> unguided, guided;

    // Noise is the standard deviation in lightness of a sample, the mean over tiles: so the few
    // tiles where fireflies are do not decide, nor those that the display saturates. Only tiles
    // that have samples of both kinds count.
    GuideComparison Compare(const Film&) const;
};

}  // namespace lull
