// Start and end of a sample, the same for all integrators, and each kind's function in between.
#pragma once

#include "renderer/base/math.h"
#include "renderer/transport/integrator.h"

namespace lull {

// The camera's ray, and the results of the dimensions before those of its path.
struct SampleStart {
    FilterSample filter;
    CameraSample camera;
    float cameraWeight;
    Ray ray;
};

// Finds where an eye's own image has a pixel of a pair, and the pixel whose random numbers it gets:
// the grain of both eyes is independent, as equal grain would be seen in the plane of the screen.
inline void PlaceInPair(const Scene& scene, const Vec2i& pixel, bool* isRight, Vec2i* seen,
                        Vec2i* seed) {
    constexpr int kFarAway = 1 << 29;  // more than an image has pixels
    *isRight = scene.rightEye && pixel.x() >= scene.film.cropMax.x();
    if (*isRight) seen->x() -= scene.film.Size().x();
    *seed = *seen;
    if (*isRight || scene.isRightAlone) seed->x() += kFarAway;
}

[[gnu::always_inline]] inline SampleStart StartSample(const Scene& scene, Sampler& sampler,
                                                      const Vec2i& pixel, uint32_t index) {
    SampleStart start;
    Vec2i seen = pixel, seed = pixel;
    if (scene.rightEye || scene.isRightAlone) [[unlikely]]
        PlaceInPair(scene, pixel, &start.camera.isRight, &seen, &seed);
    sampler.StartSample(seed, index);
    start.filter = scene.filter.Sample(sampler.Get2D());
    start.camera.film = seen.cast<float>() + Vec2f(0.5f, 0.5f) + start.filter.offset;
    if (scene.camera.HasLens()) start.camera.lens = sampler.Get2D();
    if (scene.isMoving) start.camera.time = sampler.Get1D();
    start.ray = scene.CameraOf(start.camera).GenerateRay(start.camera, &start.cameraWeight);
    return start;
}

// Returns the factor that limits radiance.
inline float LimitOf(const Scene& scene, const Rgb& L, float luminance) {
    const float most = scene.film.maxSampleLuminance;
    if (luminance > most) return most / luminance;
    if (scene.film.maxComponent == kInfinity) [[likely]]
        return 1;
    const float component = L.maxCoeff() * scene.film.scale;
    return component > scene.film.maxComponent ? scene.film.maxComponent / component : 1;
}

inline Rgb Balanced(const Scene& scene, const Rgb& L) {
    if (scene.film.colorMatrix) [[unlikely]]
        return (*scene.film.colorMatrix * L.matrix()).array();
    return L;
}

inline float WeightOf(const Scene& scene, const SampleStart& start) {
    return start.cameraWeight * start.filter.weight * scene.film.scale;
}

// Sets the radiance: limits it, applies the weights, and rejects it where it is invalid.
[[gnu::always_inline]] inline void SetRadiance(const Scene& scene, const SampleStart& start, Rgb L,
                                               PathSample* sample) {
    const float luminance = Luminance(L);
    const bool isRadiance = IsFinite(L) && !(luminance < -1e-5f);
    L *= LimitOf(scene, L, luminance);
    L = Balanced(scene, L) * WeightOf(scene, start);
    // The scale of the film may be 2^100.
    sample->rejected = !isRadiance || !IsFinite(L);
    sample->radiance = sample->rejected ? Rgb(Rgb::Zero()) : L;
}

// Return an estimate of the radiance along the camera's ray, without these weights, as those of
// the groups are, which are added to. The first hit gets all except the data of the sample itself.
Rgb Li(const PathIntegrator&, const Scene&, const PathOptions&, Sampler&, const SampleStart&,
       PathSample*);
Rgb Li(const BdptIntegrator&, const Scene&, const PathOptions&, Sampler&, const SampleStart&,
       PathSample*);

}  // namespace lull
