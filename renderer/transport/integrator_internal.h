// Start and end of a sample, the same for all integrators, and the function of each kind of
// Integrator in between.
#pragma once

#include "renderer/base/color.h"
#include "renderer/transport/integrator.h"

namespace lull {

// The camera's ray, and the results of the dimensions before those of its path.
struct SampleStart {
    FilterSample filter;
    CameraSample camera;
    float cameraWeight;
    Ray ray;
};

[[gnu::always_inline]] inline SampleStart StartSample(const Scene& scene, Sampler& sampler,
                                                      const Vec2i& pixel, uint32_t index) {
    SampleStart start;
    sampler.StartSample(pixel, index);
    start.filter = scene.filter.Sample(sampler.Get2D());
    start.camera.film = pixel.cast<float>() + Vec2f(0.5f, 0.5f) + start.filter.offset;
    if (scene.camera.HasLens()) start.camera.lens = sampler.Get2D();
    if (scene.isMoving) start.camera.time = sampler.Get1D();
    start.ray = scene.camera.GenerateRay(start.camera, &start.cameraWeight);
    return start;
}

// Rejects invalid radiance, limits it, and applies the weights.
[[gnu::always_inline]] inline PathSample Weighted(const Scene& scene, const SampleStart& start,
                                                  PathSample sample) {
    Rgb& L = sample.radiance;
    const float luminance = Luminance(L);
    const bool isRadiance = IsFinite(L) && !(luminance < -1e-5f);
    if (luminance > scene.film.maxSampleLuminance) L *= scene.film.maxSampleLuminance / luminance;
    L *= start.cameraWeight * start.filter.weight * scene.film.scale;
    // The scale of the film may be 2^100.
    if (!isRadiance || !IsFinite(L)) return {Rgb::Zero(), true, sample.vertices};
    return sample;
}

// Return an estimate of the radiance along the camera's ray, without these weights. `firstHit` is
// null, or gets all of a FirstHit except the data of the sample itself.
PathSample Li(const PathIntegrator&, const Scene&, const PathOptions&, Sampler&, const SampleStart&,
              FirstHit* firstHit);
PathSample Li(const BdptIntegrator&, const Scene&, const PathOptions&, Sampler&, const SampleStart&,
              FirstHit* firstHit);

}  // namespace lull
