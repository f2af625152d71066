// Estimates the radiance along a camera ray by paths that a guide directs.
#pragma once

#include "renderer/transport/guide_record.h"
#include "renderer/transport/path_tracer.h"

namespace lull {

// What else is to be done with a guided path. Null: nothing.
struct GuidedPathUse {
    GuideRecord* record = nullptr;  // of the guide; gets what the path finds
    float usual = 1;                // the luminance that a path usually brings, > 0
    int* vertices = nullptr;        // gets how many vertices on surfaces the path had
};

// Does as RenderSample() by Estimator::Combined, with directions that the guide chooses too. The
// mean is the same. The scene has no media. Where light spreads below a surface, its directions are
// not guided.
PathSample RenderGuidedSample(const Scene& scene, const Guide& guide, Sampler& sampler,
                              const Vec2i& pixel, uint32_t index, const GuidedPathUse& use = {});

}  // namespace lull
