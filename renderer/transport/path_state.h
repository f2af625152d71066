// A path between two vertices, and its way from one to the next.
#pragma once

#include "renderer/base/sampling.h"
#include "renderer/transport/integrator.h"
#include "renderer/transport/no_recorder.h"
#include "renderer/transport/path_vertex.h"

namespace lull {

// Constants of a path and, in `media`, the medium about its next ray: a
// policy (path_media.h).
template <typename Media>
struct PathContext {
    const Scene& scene;
    const PathIntegrator& integrator;
    Estimator estimator;
    Sampler& sampler;
    const CameraSample& camera;
    Media media;
};

// Carries the state of a path from one vertex to the next.
struct Path {
    Ray ray;
    Rgb L = Rgb::Zero();     // radiance found so far
    Rgb beta = Rgb::Ones();  // product of f cos / pdf so far
    float etaScale = 1;      // undoes the radiance scaling of refractions for Russian roulette
    bool seesLights = true;  // emission counts in full: camera ray, or after a specular bounce
    // Of the BSDF sample that made `ray`, for Estimator::Combined:
    float pdf = 0;                 // 1/sr
    Vec3f origin = Vec3f::Zero();  // the vertex
    LightChoice choice{};          // of lights there
    size_t lightPlace = 0;         // LightTable::PlaceOf() the vertex that the path has come to
    bool wentThrough = false;      // an interface, where the ray continues unscattered
};

// Returns the weight of emission that the path's own ray has found on light `index`, where light
// sampling at the last vertex would have found it with density `lightPdf`.
inline float EmissionWeight(Estimator estimator, const Path& path, int index, float lightPdf) {
    if (path.seesLights) return 1;
    if (estimator == Estimator::PbrtV3) return 0;  // counted at the last vertex
    return PowerHeuristic(path.pdf, lightPdf * path.choice.Pmf(index));
}

// Returns the emission at the end of the path's ray; `hit` is null where the ray has left the
// scene, else `found` is the same hit as the accelerator told of it. Tells the recorder of it.
template <typename Recorder>
[[gnu::always_inline]] inline Rgb Emission(const Scene& scene, Estimator estimator,
                                           const Path& path, const SurfaceInteraction* hit,
                                           const Hit& found, Recorder&& recorder) {
    if (!path.seesLights && estimator == Estimator::PbrtV3) return Rgb::Zero();
    Rgb sum = Rgb::Zero();
    if (!hit) {
        for (const int i : scene.lights.Infinite()) {
            const auto [L, pdf] = LeAndPdf(scene.lights[i], path.ray.d);
            const Rgb weighted = L * EmissionWeight(estimator, path, i, pdf);
            recorder.FindLight(path, i, weighted);
            sum += weighted;
        }
    } else if (hit->areaLight >= 0) {
        const Light& light = scene.lights[hit->areaLight];
        const Rgb L = Le(light, hit->n, hit->wo, found);
        if (IsBlack(L)) return sum;
        const float pdf = path.seesLights ? 0 : Pdf(light, path.origin, hit->p, hit->n);
        sum = L * EmissionWeight(estimator, path, hit->areaLight, pdf);
        recorder.FindLight(path, hit->areaLight, sum);
    }
    return sum;
}

// Continues the path with a sample of the BSDF or phase function. Returns false where it ends.
// `isTransmission` receives whether it goes through the surface.
template <typename Vertex>
bool Scatter(const Vertex& v, Sampler& sampler, Path* path, bool* isTransmission) {
    const auto sample = v.Sample(sampler.Get2D(), LobeSet::All);
    if (!sample) return false;
    path->beta *= sample->f * (v.Cosine(sample->wi) / sample->pdf);
    path->seesLights = sample->isSpecular;
    path->pdf = sample->pdf;
    path->origin = v.Position();
    if (sample->isSpecular && sample->isTransmission) path->etaScale *= v.EtaScale();
    path->ray = v.SpawnRay(sample->wi);
    *isTransmission = sample->isTransmission;
    return true;
}

// Ends dim paths at random and makes up for it in the others. Returns false where it ends.
// Estimator::PbrtV3 begins after four bounces, with the throughput as the probability of survival.
// Otherwise its root is, as in Cycles: early roulette then costs little variance.
template <typename Media>
bool SurvivesRoulette(const PathContext<Media>& context, int bounces, Path* path) {
    const bool isPbrtV3 = context.estimator == Estimator::PbrtV3;
    if (bounces <= (isPbrtV3 ? 3 : 2)) return true;
    const float brightest = path->beta.maxCoeff() * path->etaScale;
    if (brightest >= context.integrator.rrThreshold) return true;
    const float survival = isPbrtV3 ? std::min(0.95f, brightest) : std::sqrt(brightest);
    if (context.sampler.Get1D() >= survival) return false;
    path->beta /= survival;
    return true;
}

}  // namespace lull
