#include "renderer/transport/volume_path_tracer.h"

#include "renderer/scene/footprint.h"
#include "renderer/scene/phase.h"
#include "renderer/transport/first_hit_internal.h"
#include "renderer/transport/subsurface.h"

namespace lull {
namespace {

// Represents where a path scatters: at a surface or in a medium.
struct Vertex {
    const SurfaceInteraction* hit = nullptr;  // null in a medium
    const Bsdf* bsdf = nullptr;
    int shape = -1;
    Vec3f p, wo;
    int medium;  // of the ray that came
    float time;
    float g = 0;  // in a medium: of its phase function

    // Returns f times the cosine at a surface, the phase function in a medium, and the density.
    BsdfValue Evaluate(const Vec3f& wi, LobeSet set) const {
        if (!hit) {
            const float phase = PhaseHenyeyGreenstein(wo.dot(wi), g);
            return {Rgb::Constant(phase), phase};
        }
        BsdfValue value = bsdf->Evaluate(wo, wi, set);
        value.f *= std::abs(wi.dot(hit->ns));
        return value;
    }

    int MediumTowards(const MediumTable& media, const Vec3f& wi) const {
        return hit ? media.Beyond(shape, wi.dot(hit->n) > 0, medium) : medium;
    }
};

// Returns the point where a ray in direction w leaves the vertex.
Vec3f OriginTowards(const Vertex& v, const Vec3f& w) {
    return v.hit ? OffsetRayOrigin(v.hit->p, v.hit->pError, v.hit->n, w) : v.p;
}

// Follows a ray through interfaces and adds up what its media leave of the light.
class Beam {
  public:
    Beam(const Scene& scene, Sampler& sampler, const Ray& ray, int medium, float time)
        : ray(ray), medium(medium), scene(scene), sampler(sampler), time(time) {}

    // Goes on to the next surface, or to the end of the ray. Returns whether a surface is there.
    bool Advance() {
        const bool isHit = scene.accelerator.Intersect(ray, &found, time);
        if (medium != kVacuum) {
            Ray segment = ray;
            if (isHit) segment.tMax = found.t;
            transmittance *= scene.media.Transmittance(medium, segment, sampler);
        }
        if (!isHit) return false;
        const int material = scene.shapes.shapes[found.shape].material;
        isInterface = scene.materials.Needs(material) & kIsInterface;
        light = scene.shapes.LightAt(found);
        scene.shapes.Interact(ray, found, kNeedsNothing, &hit, time);
        medium = scene.media.Beyond(found.shape, ray.d.dot(hit.n) > 0, medium);
        return true;
    }

    Ray ray;
    Rgb transmittance = Rgb::Ones();
    // Of the surface where the beam is now:
    bool isInterface = false;
    int light = -1;
    Hit found;
    SurfaceInteraction hit;
    int medium;  // beyond it

  private:
    const Scene& scene;
    Sampler& sampler;
    float time;
};

struct Visible {
    Rgb share = Rgb::Zero();  // of the light's sample that reaches the vertex, an estimate
    // The channels in which rays that look for the light end in a medium without an end.
    Eigen::Array<bool, 3, 1> isOutOfReach = {false, false, false};
};

// Traces the shadow ray of a light's sample. As in pbrt-v3, light from infinity comes from twice
// the scene's radius away: through a medium that fills the world it would not come from farther.
Visible TraceLight(const Scene& scene, Sampler& sampler, const Vertex& v,
                   const LightSample& light) {
    const int medium = v.MediumTowards(scene.media, light.wi);
    const Vec3f origin = OriginTowards(v, light.isAtInfinity ? light.wi : Vec3f(light.p - v.p));
    const Vec3f target = light.isAtInfinity
                             ? Vec3f(v.p + scene.shapes.bounds.Diagonal().norm() * light.wi)
                             : OffsetRayOrigin(light.p, light.pError, light.n, origin - light.p);
    const auto rayFrom = [&](const Vec3f& o) { return Ray{o, target - o, 1 - 0.0001f}; };
    const Ray ray = rayFrom(origin);
    // A grazing ray that rounding turns to the other side would pass through the surface.
    if (v.hit && (ray.d.dot(v.hit->n) < 0) != (light.wi.dot(v.hit->n) < 0)) return {};
    Beam beam(scene, sampler, ray, medium, v.time);
    while (beam.Advance()) {
        if (!beam.isInterface || IsBlack(beam.transmittance)) return {};
        beam.ray = rayFrom(beam.hit.SpawnRay(beam.ray.d).o);
    }
    Visible visible{.share = beam.transmittance};
    if (light.isAtInfinity) visible.isOutOfReach = scene.media.Swallows(beam.medium);
    return visible;
}

// Returns the light that sampling light `index` brings to the vertex, weighted against sampling of
// directions. `pmf` is the probability of having chosen the light.
Rgb SampleLight(const Scene& scene, Estimator estimator, Sampler& sampler, const Vertex& v,
                int index, float pmf, const Vec2f& u) {
    const auto light = scene.lights.Sample(index, v.p, u);
    if (!light || IsBlack(light->L)) return Rgb::Zero();
    // As in the loop without media.
    const bool hasOwnRay = estimator == Estimator::PbrtV3 || light->isHidden;
    const BsdfValue value = v.Evaluate(light->wi, hasOwnRay ? LobeSet::NonSpecular : LobeSet::All);
    if (IsBlack(value.f)) return Rgb::Zero();
    const Visible visible = TraceLight(scene, sampler, v, *light);
    if (IsBlack(visible.share)) return Rgb::Zero();
    Rgb weight = Rgb::Ones();
    if (!light->isDelta) {
        weight.fill(PowerHeuristic(hasOwnRay ? light->pdf : light->pdf * pmf, value.pdf));
        // What no ray can reach keeps pbrt-v3's weight, too.
        if (!hasOwnRay && visible.isOutOfReach.any()) {
            const float pdf = v.Evaluate(light->wi, LobeSet::NonSpecular).pdf;
            weight = visible.isOutOfReach.select(PowerHeuristic(light->pdf, pdf), weight);
        }
    }
    return value.f * light->L * visible.share * weight / (light->pdf * pmf);
}

// Returns the light that a direction sampled for it finds on light `index`: the other half of
// pbrt-v3's direct light.
Rgb SampleDirectionForLight(const Scene& scene, Sampler& sampler, const Vertex& v, int index,
                            float pmf, const Vec2f& u) {
    const AreaLight* area = std::get_if<AreaLight>(&scene.lights[index]);
    const InfiniteLight* environment = std::get_if<InfiniteLight>(&scene.lights[index]);
    if (!area && !environment) return Rgb::Zero();  // a direction cannot be found by chance
    if (area && area->isHidden) return Rgb::Zero();
    Vec3f wi;
    Rgb f = Rgb::Ones();  // over the density
    float pdf;
    if (v.hit) {
        const auto sample = v.bsdf->Sample(v.wo, u, LobeSet::NonSpecular);
        if (!sample) return Rgb::Zero();
        wi = sample->wi;
        pdf = sample->pdf;
        f = sample->f * (std::abs(wi.dot(v.hit->ns)) / pdf);
    } else {
        wi = SampleHenyeyGreenstein(v.wo, v.g, u);
        pdf = PhaseHenyeyGreenstein(v.wo.dot(wi), v.g);
    }
    Beam beam(scene, sampler, {OriginTowards(v, wi), wi, kInfinity},
              v.MediumTowards(scene.media, wi), v.time);
    bool isHit;
    while ((isHit = beam.Advance()) && beam.isInterface) {
        if (IsBlack(beam.transmittance)) return Rgb::Zero();
        beam.ray = beam.hit.SpawnRay(wi);
    }
    Rgb L;
    float lightPdf;
    if (environment) {
        if (isHit) return Rgb::Zero();
        lightPdf = environment->Pdf(wi);
        L = environment->Le(wi);
    } else {
        if (!isHit || beam.light != index) return Rgb::Zero();
        lightPdf = area->Pdf(v.p, beam.hit.p, beam.hit.n);
        L = area->Le(beam.hit.n, -wi, beam.found);
    }
    if (lightPdf == 0) return Rgb::Zero();
    return f * L * beam.transmittance * (PowerHeuristic(pdf, lightPdf) / pmf);
}

// Samples direct light as the estimator says: chooses one light of the table `choice`.
Rgb SampleDirectLight(const Scene& scene, Estimator estimator, Sampler& sampler, const Vertex& v,
                      const LightChoice& choice) {
    float pmf;
    const int index = choice.Sample(sampler.Get1D(), &pmf);
    if (!(pmf > 0)) return Rgb::Zero();
    Rgb L = SampleLight(scene, estimator, sampler, v, index, pmf, sampler.Get2D());
    if (estimator == Estimator::PbrtV3)
        L += SampleDirectionForLight(scene, sampler, v, index, pmf, sampler.Get2D());
    return L;
}

// Continues the path, which the surface has let in, from where it leaves the solid; adds the light
// that arrives there directly. Returns false where it ends.
[[gnu::noinline]] bool ScatterBelow(const Scene& scene, Estimator estimator, Sampler& sampler,
                                    const Vertex& v, Path* path, int* medium, Rgb* L) {
    const auto profile = scene.materials.Profile(scene.textures, *v.hit);
    if (!profile) return true;
    const auto exit = SampleSubsurface(scene, sampler, *v.hit, *v.bsdf, *profile, v.time);
    if (!exit) return false;
    path->beta *= exit->weight;
    const Bsdf out = ExitBsdf(*exit, profile->eta);
    const Vertex last{.hit = &exit->hit,
                      .bsdf = &out,
                      .shape = exit->shape,
                      .p = exit->hit.p,
                      .wo = exit->hit.wo,
                      .medium = v.medium,
                      .time = v.time};
    if (scene.lights.Count() > 0) {
        path->choice = scene.lights.Choice(last.p);
        *L += path->beta * SampleDirectLight(scene, estimator, sampler, last, path->choice);
    }
    if (!Scatter(out, exit->hit, sampler, path)) return false;
    *medium = last.MediumTowards(scene.media, path->ray.d);
    return true;
}

// Continues the path from a point in a medium.
void ScatterInMedium(const Vertex& v, Sampler& sampler, Path* path) {
    const Vec3f wi = SampleHenyeyGreenstein(v.wo, v.g, sampler.Get2D());
    path->pdf = PhaseHenyeyGreenstein(v.wo.dot(wi), v.g);
    path->origin = v.p;
    path->seesLights = false;
    path->ray = {v.p, wi, kInfinity};
}

// Follows a path from the camera.
template <typename Recorder>
Rgb TracePath(const Scene& scene, Estimator estimator, Sampler& sampler, const Ray& ray,
              const Vec2f& film, const Vec2f& lens, float time, Recorder& firstHit) {
    Rgb L = Rgb::Zero();
    Path path{.ray = ray};
    int medium = scene.media.ofCamera;
    const auto direct = [&](const Vertex& v) {
        if (scene.lights.Count() == 0) return;
        path.choice = scene.lights.Choice(v.p);
        L += path.beta * SampleDirectLight(scene, estimator, sampler, v, path.choice);
    };
    for (int bounces = 0;; ++bounces) {
        // Stop where the ray could only add emission that has been counted or cannot be found.
        const bool isLast = bounces >= scene.maxDepth;
        const bool emissionCounts = path.seesLights || estimator == Estimator::Combined;
        if (isLast && !(emissionCounts && scene.lights.AnyVisible()) && !firstHit.Wanted()) break;

        // Find the next vertex: a surface, or a point in the medium before it.
        Hit found;
        const bool isHit = scene.accelerator.Intersect(path.ray, &found, time);
        MediumSample inMedium;
        if (medium != kVacuum) {
            Ray segment = path.ray;
            if (isHit) segment.tMax = found.t;
            inMedium = scene.media.Sample(medium, segment, sampler);
            path.beta *= inMedium.weight;
            if (IsBlack(path.beta)) break;
        }
        if (inMedium.t) {
            firstHit.Advance(*inMedium.t);
            firstHit.MeetMedium(path, path.ray.o + *inMedium.t * path.ray.d);
            if (isLast) break;
            const Vec3f p = path.ray.o + *inMedium.t * path.ray.d;
            if (!(p.squaredNorm() <= Sqr(scene.shapes.reach))) break;  // no ray starts there
            const Vertex v{.p = p,
                           .wo = -path.ray.d.normalized(),
                           .medium = medium,
                           .time = time,
                           .g = scene.media.PhaseParameter(medium)};
            direct(v);
            ScatterInMedium(v, sampler, &path);
        } else {
            if (!isHit) {
                firstHit.LeaveScene(path, scene, estimator);
                L += path.beta * Emission(scene, estimator, path, nullptr, found);
                break;
            }
            firstHit.Advance(found.t);
            SurfaceInteraction hit;
            const SurfaceNeeds needs =
                scene.materials.Needs(scene.shapes.shapes[found.shape].material);
            scene.shapes.Interact(path.ray, found, needs, &hit, time);
            if (bounces == 0 && (needs & kNeedsFootprint) && !path.wentThrough)
                ComputeFootprint(scene.camera, film, lens, time, scene.camera.sampleSpacing, &hit);
            if (hit.areaLight >= 0) L += path.beta * Emission(scene, estimator, path, &hit, found);
            if (needs & kIsInterface) {
                // What lies behind still belongs to the last vertex, whose shadow rays see it; rays
                // that count in full end here, as with pbrt-v3.
                if (isLast && path.seesLights) break;
                medium = scene.media.Beyond(found.shape, path.ray.d.dot(hit.n) > 0, medium);
                path.ray = hit.SpawnRay(path.ray.d);
                path.wentThrough = true;
                --bounces;
                continue;
            }
            if (isLast && !firstHit.Wanted()) break;
            const Bsdf bsdf = scene.materials.MakeBsdf(scene.textures, &hit);
            firstHit.MeetSurface(path, scene, estimator, found, hit, bsdf);
            if (isLast) break;
            const Vertex v{.hit = &hit,
                           .bsdf = &bsdf,
                           .shape = found.shape,
                           .p = hit.p,
                           .wo = hit.wo,
                           .medium = medium,
                           .time = time};
            if (bsdf.LobeCount(LobeSet::NonSpecular) > 0) direct(v);
            bool isTransmission;
            if (!Scatter(bsdf, hit, sampler, &path, &isTransmission)) break;
            medium = v.MediumTowards(scene.media, path.ray.d);
            if ((needs & kScattersBelow) && isTransmission &&
                !ScatterBelow(scene, estimator, sampler, v, &path, &medium, &L))
                break;
        }
        if (bounces > 3 && !SurvivesRoulette(scene.rrThreshold, sampler, &path)) break;
    }
    return L;
}

}  // namespace

Rgb VolumeRadiance(const Scene& scene, Estimator estimator, Sampler& sampler, const Ray& ray,
                   const Vec2f& film, const Vec2f& lens, float time) {
    NoFirstHit nobodyAsks;
    return TracePath(scene, estimator, sampler, ray, film, lens, time, nobodyAsks);
}

Rgb VolumeRadiance(const Scene& scene, Estimator estimator, Sampler& sampler, const Ray& ray,
                   const Vec2f& film, const Vec2f& lens, float time, FirstHitRecorder* firstHit) {
    return TracePath(scene, estimator, sampler, ray, film, lens, time, *firstHit);
}

}  // namespace lull
