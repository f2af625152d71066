#include "renderer/transport/path_tracer.h"

#include "renderer/base/color.h"
#include "renderer/scene/footprint.h"
#include "renderer/transport/first_hit_internal.h"
#include "renderer/transport/guided_path.h"
#include "renderer/transport/guided_path_tracer.h"
#include "renderer/transport/path_state.h"
#include "renderer/transport/subsurface.h"
#include "renderer/transport/volume_path_tracer.h"

namespace lull {
namespace {

// Traces the ray from a surface point to a light's point. Both ends are moved off their surfaces;
// the factor keeps the light's own surface out (pbrt-v3's ShadowEpsilon). Where that or rounding
// turns a grazing ray to the other side of the surface, it would pass through: that is in shadow.
[[gnu::always_inline]] inline bool IsVisible(const Scene& scene, const SurfaceInteraction& hit,
                                             const LightSample& light, float time) {
    if (light.isAtInfinity) return !scene.accelerator.Occluded(hit.SpawnRay(light.wi), time);
    const Vec3f origin = OffsetRayOrigin(hit.p, hit.pError, hit.n, light.wi);
    const Vec3f target = OffsetRayOrigin(light.p, light.pError, light.n, origin - light.p);
    const Vec3f d = target - origin;
    if ((d.dot(hit.n) < 0) != (light.wi.dot(hit.n) < 0)) return false;
    return !scene.accelerator.Occluded({origin, d, 1 - 0.0001f}, time);
}

// Returns the light that sampling light `index` brings to the hit, weighted against BSDF sampling.
// `pmf` is the probability of having chosen the light.
template <typename Guiding>
[[gnu::always_inline]] inline Rgb SampleLight(const Scene& scene, Estimator estimator,
                                              const SurfaceInteraction& hit, const Bsdf& bsdf,
                                              const Guiding& guiding, int index, float pmf,
                                              const Vec2f& u, float time) {
    const auto light = scene.lights.Sample(index, hit.p, u);
    if (!light || IsBlack(light->L)) return Rgb::Zero();
    // With a BSDF ray of its own, direct light is sampled without the specular lobes; the ray that
    // continues the path is sampled from all of them. A light that rays cannot hit keeps
    // pbrt-v3's weight in both, so that the mean stays the same.
    const bool hasOwnRay = estimator == Estimator::PbrtV3 || light->isHidden;
    const BsdfValue value =
        !hasOwnRay ? bsdf.Evaluate(hit.wo, light->wi, LobeSet::All)
        : estimator == Estimator::PbrtV3
            ? bsdf.Evaluate(hit.wo, light->wi, LobeSet::NonSpecular)
            : bsdf.WithoutShares().Evaluate(hit.wo, light->wi, LobeSet::NonSpecular);
    if (IsBlack(value.f)) return Rgb::Zero();
    const float weight = light->isDelta ? 1
                         : hasOwnRay
                             ? PowerHeuristic(light->pdf, value.pdf)
                             : PowerHeuristic(light->pdf * pmf, guiding.Pdf(value.pdf, light->wi));
    const Rgb L =
        value.f * light->L * (std::abs(light->wi.dot(hit.ns)) * weight / (light->pdf * pmf));
    if (IsBlack(L) || !IsVisible(scene, hit, *light, time)) return Rgb::Zero();
    return L;
}

// Returns the light that a BSDF sample of its own finds on light `index`: the other half of
// pbrt-v3's direct light.
Rgb SampleBsdfForLight(const Scene& scene, const SurfaceInteraction& hit, const Bsdf& bsdf,
                       int index, float pmf, const Vec2f& u, float time) {
    const Light& light = scene.lights[index];
    const AreaLight* area = std::get_if<AreaLight>(&light);
    const InfiniteLight* environment = std::get_if<InfiniteLight>(&light);
    if (!area && !environment) return Rgb::Zero();  // a direction cannot be found by chance
    if (area && area->isHidden) return Rgb::Zero();
    const auto sample = bsdf.Sample(hit.wo, u, LobeSet::NonSpecular);
    if (!sample) return Rgb::Zero();
    const Ray ray = hit.SpawnRay(sample->wi);
    Rgb L;
    float lightPdf;
    if (environment) {
        lightPdf = environment->Pdf(sample->wi);
        if (lightPdf == 0 || scene.accelerator.Occluded(ray, time)) return Rgb::Zero();
        L = environment->Le(sample->wi);
    } else {
        Hit lightHit;
        if (!scene.accelerator.Intersect(ray, &lightHit, time) ||
            scene.shapes.LightAt(lightHit) != index)
            return Rgb::Zero();
        SurfaceInteraction at;
        scene.shapes.Interact(ray, lightHit, kNeedsNothing, &at);
        L = area->Le(at.n, -sample->wi, lightHit);
        lightPdf = area->Pdf(hit.p, at.p, at.n);
        if (lightPdf == 0) return Rgb::Zero();
    }
    return sample->f * L *
           (std::abs(sample->wi.dot(hit.ns)) * PowerHeuristic(sample->pdf, lightPdf) /
            (sample->pdf * pmf));
}

// Samples direct light as the estimator says: chooses one light of the table `choice`.
template <typename Guiding>
[[gnu::always_inline]] inline Rgb SampleDirectLight(const Scene& scene, Estimator estimator,
                                                    Sampler& sampler, const SurfaceInteraction& hit,
                                                    const Bsdf& bsdf, const Guiding& guiding,
                                                    const LightChoice& choice, float time) {
    float pmf;
    const int index = choice.Sample(sampler.Get1D(), &pmf);
    if (!(pmf > 0)) return Rgb::Zero();
    Rgb L = SampleLight(scene, estimator, hit, bsdf, guiding, index, pmf, sampler.Get2D(), time);
    if (estimator == Estimator::PbrtV3)
        L += SampleBsdfForLight(scene, hit, bsdf, index, pmf, sampler.Get2D(), time);
    return L;
}

// Continues the path, which the surface has let in, from where it leaves the solid; adds the light
// that arrives there directly. Returns false where it ends.
[[gnu::noinline]] bool ScatterBelow(const Scene& scene, Estimator estimator, Sampler& sampler,
                                    const SurfaceInteraction& hit, const Bsdf& bsdf, float time,
                                    Path* path, Rgb* L) {
    const auto profile = scene.materials.Profile(scene.textures, hit);
    if (!profile) return true;
    const auto exit = SampleSubsurface(scene, sampler, hit, bsdf, *profile, time);
    if (!exit) return false;
    path->beta *= exit->weight;
    const Bsdf out = ExitBsdf(*exit, profile->eta);
    if (scene.lights.Count() > 0) {
        path->choice = scene.lights.Choice(exit->hit, out);
        *L += path->beta * SampleDirectLight(scene, estimator, sampler, exit->hit, out, Unguided(),
                                             path->choice, time);
    }
    return Scatter(out, exit->hit, sampler, path);
}

// Carries the ray on behind an interface. As with pbrt-v3's path integrator, which blocks shadow
// rays there, lights behind it are seen only by rays for which emission counts in full.
[[gnu::always_inline]] inline void GoThrough(const SurfaceInteraction& hit, Path* path) {
    path->ray = hit.SpawnRay(path->ray.d);
    path->pdf = 0;
    path->wentThrough = true;
}

template <typename Guiding, typename Recorder>
Rgb Trace(const Scene& scene, Estimator estimator, Sampler& sampler, const Ray& ray,
          const Vec2f& film, const Vec2f& lens, float time, Guiding& guiding, Recorder& firstHit) {
    Rgb L = Rgb::Zero();
    Path path{.ray = ray};
    for (int bounces = 0;; ++bounces) {
        // Stop where the ray could only add emission that has been counted or cannot be found.
        const bool isLast = bounces >= scene.maxDepth;
        const bool emissionCounts = path.seesLights || estimator == Estimator::Combined;
        if (isLast && !(emissionCounts && scene.lights.AnyVisible()) && !firstHit.Wanted()) break;

        // Find the next vertex and add what it emits.
        Hit found;
        if (!scene.accelerator.Intersect(path.ray, &found, time)) {
            firstHit.LeaveScene(path, scene, estimator);
            L += path.beta * Emission(scene, estimator, path, nullptr, found);
            break;
        }
        firstHit.Advance(found.t);
        scene.lights.Prefetch(path.ray.o + found.t * path.ray.d);
        const Shape& shape = scene.shapes.shapes[found.shape];
        if (isLast && shape.firstLight < 0 && !firstHit.Wanted()) break;
        SurfaceInteraction hit;
        const SurfaceNeeds needs = scene.materials.Needs(shape.material);
        scene.shapes.Interact(path.ray, found, needs, &hit, time);
        if (bounces == 0 && (needs & kNeedsFootprint) && !path.wentThrough)
            ComputeFootprint(scene.camera, film, lens, time, scene.camera.sampleSpacing, &hit);
        if (hit.areaLight >= 0) L += path.beta * Emission(scene, estimator, path, &hit, found);
        if (isLast && !firstHit.Wanted()) break;
        if (needs & kIsInterface) {
            if (isLast) break;
            GoThrough(hit, &path);
            --bounces;
            continue;
        }

        // Sample the light that arrives directly from lights.
        Bsdf bsdf = scene.materials.MakeBsdf(scene.textures, &hit);
        firstHit.MeetSurface(path, scene, estimator, found, hit, bsdf);
        if (isLast) break;
        if (estimator == Estimator::Combined) bsdf.ChooseByShare(hit.wo);
        guiding.Enter(hit, bsdf, !(needs & kScattersBelow));
        if (bsdf.LobeCount(LobeSet::NonSpecular) > 0 && scene.lights.Count() > 0) {
            path.choice = scene.lights.Choice(hit, bsdf);
            L += path.beta * SampleDirectLight(scene, estimator, sampler, hit, bsdf, guiding,
                                               path.choice, time);
        }

        bool isTransmission;
        if (!guiding.Scatter(bsdf, hit, L, sampler, &path, &isTransmission)) break;
        if ((needs & kScattersBelow) && isTransmission) [[unlikely]] {
            // Works on copies: what it has a pointer to would lie in memory all along.
            Path below = path;
            Rgb arriving = Rgb::Zero();
            const bool leaves =
                ScatterBelow(scene, estimator, sampler, hit, bsdf, time, &below, &arriving);
            path = below;
            L += arriving;
            if (!leaves) break;
        }
        if (bounces > 3 && !guiding.SurvivesRoulette(scene.rrThreshold, sampler, &path)) break;
    }
    guiding.End(L);
    return L;
}

// Takes a sample; `radiance(ray, film, lens, time)` is that of its path.
template <typename Radiance>
PathSample TakeSample(const Scene& scene, Sampler& sampler, const Vec2i& pixel, uint32_t index,
                      const Radiance& radiance, FirstHit* firstHit = nullptr) {
    sampler.StartSample(pixel, index);
    const FilterSample filter = scene.filter.Sample(sampler.Get2D());
    if (firstHit) *firstHit = {.weight = filter.weight, .offset2 = filter.offset.squaredNorm()};
    const Vec2f film = pixel.cast<float>() + Vec2f(0.5f, 0.5f) + filter.offset;
    const Vec2f lens = scene.camera.HasLens() ? sampler.Get2D() : Vec2f(0.5f, 0.5f);
    const float time = scene.isMoving ? sampler.Get1D() : 0;
    float cameraWeight;
    const Ray ray = scene.camera.GenerateRay(film, lens, time, &cameraWeight);
    if (cameraWeight == 0) return {Rgb::Zero(), false};
    Rgb L = radiance(ray, film, lens, time);
    const float luminance = Luminance(L);
    if (!IsFinite(L) || luminance < -1e-5f) return {Rgb::Zero(), true};
    if (luminance > scene.film.maxSampleLuminance) L *= scene.film.maxSampleLuminance / luminance;
    return {L * (cameraWeight * filter.weight * scene.film.scale), false};
}

}  // namespace

Rgb Radiance(const Scene& scene, Estimator estimator, Sampler& sampler, const Ray& ray,
             const Vec2f& film, const Vec2f& lens, float time) {
    Unguided unguided;
    NoFirstHit nobodyAsks;
    return Trace(scene, estimator, sampler, ray, film, lens, time, unguided, nobodyAsks);
}

PathSample RenderSample(const Scene& scene, Estimator estimator, Sampler& sampler,
                        const Vec2i& pixel, uint32_t index) {
    const auto radiance = [&](const Ray& ray, const Vec2f& film, const Vec2f& lens, float time) {
        return scene.isVolumetric ? VolumeRadiance(scene, estimator, sampler, ray, film, lens, time)
                                  : Radiance(scene, estimator, sampler, ray, film, lens, time);
    };
    return TakeSample(scene, sampler, pixel, index, radiance);
}

PathSample RenderGuidedSample(const Scene& scene, const Guide& guide, Sampler& sampler,
                              const Vec2i& pixel, uint32_t index, const GuidedPathUse& use) {
    const auto radiance = [&](const Ray& ray, const Vec2f& film, const Vec2f& lens, float time) {
        NoFirstHit nobodyAsks;
        Guided guided(guide, use.record, use.usual);
        const Rgb L =
            Trace(scene, Estimator::Combined, sampler, ray, film, lens, time, guided, nobodyAsks);
        if (use.vertices) *use.vertices = guided.Vertices();
        return L;
    };
    return TakeSample(scene, sampler, pixel, index, radiance);
}

PathSample RenderSample(const Scene& scene, Estimator estimator, Sampler& sampler,
                        const Vec2i& pixel, uint32_t index, bool throughSpecular,
                        FirstHit* firstHit) {
    const auto radiance = [&](const Ray& ray, const Vec2f& film, const Vec2f& lens, float time) {
        FirstHitRecorder recorder(scene.camera, ray, time, throughSpecular, firstHit);
        if (scene.isVolumetric)
            return VolumeRadiance(scene, estimator, sampler, ray, film, lens, time, &recorder);
        Unguided unguided;
        return Trace(scene, estimator, sampler, ray, film, lens, time, unguided, recorder);
    };
    return TakeSample(scene, sampler, pixel, index, radiance, firstHit);
}

PathSample RenderGuidedSample(const Scene& scene, const Guide& guide, Sampler& sampler,
                              const Vec2i& pixel, uint32_t index, bool throughSpecular,
                              FirstHit* firstHit) {
    const auto radiance = [&](const Ray& ray, const Vec2f& film, const Vec2f& lens, float time) {
        FirstHitRecorder recorder(scene.camera, ray, time, throughSpecular, firstHit);
        Guided guided(guide, nullptr, 1);
        return Trace(scene, Estimator::Combined, sampler, ray, film, lens, time, guided, recorder);
    };
    return TakeSample(scene, sampler, pixel, index, radiance, firstHit);
}

}  // namespace lull
