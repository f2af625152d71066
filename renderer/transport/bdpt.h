// Bidirectional path tracing (Lafortune and Willems 1993; Veach and Guibas 1994; pbrt 3rd ed.,
// 16.3). Samples of pixels are taken by RenderSample(), with all strategies but the one that sees a
// path from a light; that fills an image of its own, from light paths.
#pragma once

#include <vector>

#include "renderer/transport/integrator.h"

namespace lull {

// Returns how many light paths there are for each sample of all pixels, at these shares; 0 if the
// camera sees no points, shapes are hidden from it, or no light shines.
double LightPathCount(const Scene&, const BdptShares&);

// A contribution of a light path to the image.
struct Splat {
    Vec2f film;             // pixels
    Rgb radiance;           // film scale applied; pixels are sums of these, times the filter
    int light;              // of the scene, that it comes from
    bool rejected = false;  // was not finite, or of negative luminance, and is black
};

// Traces light path `index` of those that belong to sample `round` of all pixels, and replaces
// `splats` by its contributions, at most one a vertex. They depend on the sampler's seed and on
// these alone. The scene's integrator is BdptIntegrator.
void TraceLightPath(const Scene&, const BdptShares&, Sampler&, uint32_t round, uint32_t index,
                    std::vector<Splat>* splats);

}  // namespace lull
