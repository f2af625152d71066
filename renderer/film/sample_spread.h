// Tells how noisy the samples of a tile are, and how long their paths.
#pragma once

#include <cstdint>

namespace lull {

// Sums up samples of a tile.
struct SampleSpread {
    double squares = 0;    // of luminance, about the means of its pixels
    int64_t freedom = 0;   // how many of these are independent
    int64_t vertices = 0;  // of paths, without the camera
    int64_t samples = 0;
    double connected = 0;  // squares of the luminance that connections have found
    double light = 0;      // of that of light paths, one by one, in the round
};

}  // namespace lull
