// Accumulates the features of first hits that a denoiser fits colours to, by halves of the
// samples.
#pragma once

#include "renderer/base/color.h"
#include "renderer/film/pixel_plane.h"
#include "renderer/transport/first_hit.h"

namespace lull {

// The sums of a pixel, added to in the order of the samples as FilmPixel is.
struct FeaturePixel {
    // Albedo R, G, B, normal X, Y, Z, weighted by the pixel filter as the image is, and one over
    // the depth, which is 0 where nothing is met. Of the samples that are in the half (InHalf()),
    // and of the others.
    std::array<std::array<float, 7>, 2> sums = {};
    float squares = 0;  // of all samples' luminance

    void Add(const FirstHit& hit, const Rgb& radiance, bool inHalf) {
        std::array<float, 7>& sum = sums[inHalf ? 0 : 1];
        for (size_t c = 0; c < 3; ++c) {
            sum[c] += hit.weight * hit.albedo[int(c)];
            sum[3 + c] += hit.weight * hit.normal[int(c)];
        }
        if (hit.found && hit.depth > 0) sum[6] += 1 / std::max(hit.depth, 1e-12f);
        const float y = Luminance(radiance);
        squares += y * y;
    }
    bool operator==(const FeaturePixel&) const = default;
};

// These pixels of the region that its Film has: 60 bytes a pixel.
using FeatureFilm = PixelPlane<FeaturePixel>;

}  // namespace lull
