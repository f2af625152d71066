// Says of samples what their paths have met first, for layers beside the image.
#pragma once

#include "renderer/output/aov_film.h"
#include "renderer/transport/guide.h"
#include "renderer/transport/path_tracer.h"

namespace lull {

// Takes the same sample as RenderSample() does otherwise, and says what its path has met first.
// With `throughSpecular` (see AovSet), albedo is that of what is seen times what mirrors and glass
// leave of it, and depth goes on by the way behind them, as if they were windows. A path that is at
// its greatest depth, or ends before it finds something, has found nothing.
PathSample RenderSample(const Scene& scene, Estimator estimator, Sampler& sampler,
                        const Vec2i& pixel, uint32_t index, bool throughSpecular,
                        FirstHit* firstHit);

// Does the same beside RenderGuidedSample().
PathSample RenderGuidedSample(const Scene& scene, const Guide& guide, Sampler& sampler,
                              const Vec2i& pixel, uint32_t index, bool throughSpecular,
                              FirstHit* firstHit);

}  // namespace lull
