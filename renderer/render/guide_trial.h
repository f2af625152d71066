// Tries a guide out: what it does to the variance of samples and to the length of paths.
#pragma once

#include <optional>

#include "renderer/guiding/guide.h"
#include "renderer/render/render.h"

namespace lull {

// Holds what guided samples are over unguided ones.
struct GuideTrial {
    double variance = 1;  // of a sample: the square of the ratio of noise, see below
    double error = 0;     // standard error of that
    double vertices = 1;  // of a path
    int samples = 0;      // per pixel that were taken, of both kinds together
};

// Noise is the standard deviation in lightness of a sample, the mean over pieces of 8x8 pixels: so
// the few pieces where fireflies are do not decide, nor those that the display saturates.
//
// Takes a few samples of each kind of all pixels of the region; `options` are for its threads,
// sampler and seed, and to be cancelled. Returns nothing if it was. The result is the same bits for
// any number of threads.
std::optional<GuideTrial> TryGuide(const Scene&, const PixelRect& region, const Guide&,
                                   const RenderOptions& options);

}  // namespace lull
