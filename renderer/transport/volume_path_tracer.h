// Traces paths through participating media: pbrt-v3's volpath. A loop of its own, so that scenes
// without media do not pay for them.
#pragma once

#include "renderer/transport/path_tracer.h"

namespace lull {

// Returns the radiance that arrives along the camera ray through `film` (pixels) and `lens` at
// `time` (of 1), which surfaces and media scatter. Shadow rays go through surfaces of material
// none.
Rgb VolumeRadiance(const Scene& scene, Estimator estimator, Sampler& sampler, const Vec2f& film,
                   const Vec2f& lens, float time);

}  // namespace lull
