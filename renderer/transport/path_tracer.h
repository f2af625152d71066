// Estimates the radiance along a camera ray by tracing paths.
#pragma once

#include "renderer/scene/scene.h"

namespace lull {

// PbrtV3 takes pbrt-v3's strategies as they are: at each vertex one light is chosen and sampled
// both by the light and by a BSDF ray of its own. Combined has the same mean from fewer rays: the
// ray that continues the path is the BSDF sample of the direct light as well, weighed against
// the choice of *any* light.
enum class Estimator { Combined, PbrtV3 };

struct PathSample {
    Rgb radiance;   // filter weight and film scale applied: the pixel is the mean of these
    bool rejected;  // was NaN, infinite or of negative luminance, and counts as black
};

// Takes sample `index` of `pixel` (full-image coordinates). The result depends on (seed, pixel,
// index) alone, whatever the thread or the order.
PathSample RenderSample(const Scene& scene, Estimator estimator, Sampler& sampler,
                        const Vec2i& pixel, uint32_t index);

// Returns the radiance that arrives at `time`, from 0 where the shutter opens to 1, along `ray`:
// the camera's through `film` (pixels) and `lens`.
Rgb Radiance(const Scene& scene, Estimator estimator, Sampler& sampler, const Ray& ray,
             const Vec2f& film, const Vec2f& lens, float time);

}  // namespace lull
