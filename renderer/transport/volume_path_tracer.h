// Traces paths through participating media: pbrt-v3's volpath. A loop of its own, so that scenes
// without media do not pay for them.
#pragma once

#include "renderer/transport/path_tracer.h"

namespace lull {

// Returns the radiance that arrives at `time` (of 1) along `ray`, the camera's through `film`
// (pixels) and `lens`, which surfaces and media scatter. Shadow rays go through surfaces of
// material none.
Rgb VolumeRadiance(const Scene& scene, Estimator estimator, Sampler& sampler, const Ray& ray,
                   const Vec2f& film, const Vec2f& lens, float time);

class FirstHitRecorder;

// Returns the same, and tells the recorder what the path has met first.
Rgb VolumeRadiance(const Scene& scene, Estimator estimator, Sampler& sampler, const Ray& ray,
                   const Vec2f& film, const Vec2f& lens, float time, FirstHitRecorder* firstHit);

}  // namespace lull
