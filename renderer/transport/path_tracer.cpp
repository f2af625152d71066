#include "renderer/transport/path_tracer.h"

#include "renderer/base/color.h"
#include "renderer/scene/footprint.h"
#include "renderer/transport/direct_light.h"
#include "renderer/transport/first_hit_internal.h"
#include "renderer/transport/path_recorder_internal.h"
#include "renderer/transport/subsurface.h"

namespace lull {
namespace {

// Continues the path, which the surface has let in, from where it leaves the solid; adds the light
// that arrives there directly. Returns false where it ends.
template <typename Media, typename Guiding>
[[gnu::noinline]] bool ScatterBelow(PathContext<Media>* context, const SurfaceVertex& v,
                                    Guiding& guiding, Path* path, Rgb* L) {
    const Scene& scene = context->scene;
    const auto profile = scene.materials.Profile(scene.textures, v.hit);
    if (!profile) {
        context->media.Leave(v, path->ray.d);
        return true;
    }
    const auto exit =
        SampleSubsurface(scene, context->sampler, v.hit, v.bsdf, *profile, context->camera.time);
    if (!exit) return false;
    path->beta *= exit->weight;
    const Bsdf out = ExitBsdf(*exit, profile->eta);
    const SurfaceVertex last{exit->hit, out, exit->shape};
    guiding.Enter(last, true);
    if (scene.lights.Count() > 0)
        *L += path->beta * SampleDirectLight(*context, last, guiding, path);
    bool isTransmission;
    if (!guiding.Scatter(last, *L, context->sampler, path, &isTransmission)) return false;
    context->media.Leave(last, path->ray.d);
    return true;
}

// Follows a path along `ray`, the camera's. Compiled for each kind of Media, Guiding and Recorder,
// so that what a scene does not have and nobody asks for costs nothing.
template <typename Media, typename Guiding, typename Recorder>
[[gnu::noinline]] Rgb Trace(PathContext<Media> context, const Ray& ray, Guiding& guiding,
                            Recorder& firstHit) {
    const Scene& scene = context.scene;
    const Estimator estimator = context.estimator;
    Sampler& sampler = context.sampler;
    const float time = context.camera.time;
    Rgb L = Rgb::Zero();
    Path path{.ray = ray};
    for (int bounces = 0;; ++bounces) {
        // Stop where the ray could only add emission that has been counted or cannot be found.
        const bool isLast = bounces >= scene.maxDepth;
        const bool emissionCounts = path.seesLights || estimator == Estimator::Combined;
        if (isLast && !(emissionCounts && scene.lights.AnyVisible()) && !firstHit.Wanted()) break;

        // Find the next vertex: a surface, or a point in the medium before it.
        Hit found;
        const bool isHit = scene.accelerator.Intersect(path.ray, &found, time);
        if constexpr (Media::kExist) {
            const float end = isHit ? found.t : path.ray.tMax;
            const MediumSample inMedium = context.media.Sample(path.ray, end, sampler);
            path.beta *= inMedium.weight;
            if (IsBlack(path.beta)) break;
            if (inMedium.t) {
                const Vec3f p = path.ray.o + *inMedium.t * path.ray.d;
                if (!(p.squaredNorm() <= Sqr(scene.shapes.reach))) break;  // no ray starts there
                const MediumVertex v{p, -path.ray.d.normalized(), context.media.PhaseParameter()};
                firstHit.Advance(*inMedium.t);
                scene.lights.Prefetch(v.p);
                firstHit.MeetMedium(path, v.p);
                if (isLast) break;
                guiding.Enter(v);
                if (scene.lights.Count() > 0)
                    L += path.beta * SampleDirectLight(context, v, guiding, &path);
                firstHit.Light(L);
                bool isTransmission;
                if (!guiding.Scatter(v, L, sampler, &path, &isTransmission)) break;
                firstHit.Scatter(path, true);
                if (bounces > 3 && !guiding.SurvivesRoulette(scene.rrThreshold, sampler, &path))
                    break;
                continue;
            }
        }

        // Add what the surface, or the sky, emits.
        if (!isHit) {
            firstHit.LeaveScene(path);
            L += path.beta * Emission(scene, estimator, path, nullptr, found);
            firstHit.Emit(L);
            break;
        }
        firstHit.Advance(found.t);
        scene.lights.Prefetch(path.ray.o + found.t * path.ray.d);
        const Shape& shape = scene.shapes.shapes[found.shape];
        const SurfaceNeeds needs = scene.materials.Needs(shape.material);
        const bool endsHere = isLast && !firstHit.Wanted() && !Media::LooksBehind(needs);
        if (endsHere && shape.firstLight < 0) break;
        SurfaceInteraction hit;
        scene.shapes.Interact(path.ray, found, needs, &hit, time);
        if (bounces == 0 && (needs & kNeedsFootprint) && !path.wentThrough)
            ComputeFootprint(scene.camera, context.camera, &hit);
        firstHit.ReachSurface(path, found, hit);
        if (hit.areaLight >= 0) L += path.beta * Emission(scene, estimator, path, &hit, found);
        firstHit.Emit(L);
        if (endsHere) break;
        if (needs & kIsInterface) {
            if (!context.media.GoThrough(hit, found.shape, isLast, &path)) break;
            firstHit.Scatter(path, true);
            --bounces;
            continue;
        }

        // Sample the light that arrives directly from lights.
        Bsdf bsdf = scene.materials.MakeBsdf(scene.textures, &hit);
        firstHit.MeetSurface(path, found, hit, bsdf);
        if (isLast) break;
        if (estimator == Estimator::Combined) bsdf.ChooseByShare(hit.wo);
        const SurfaceVertex v{hit, bsdf, found.shape};
        guiding.Enter(v, !(needs & kScattersBelow));
        if (bsdf.LobeCount(LobeSet::NonSpecular) > 0 && scene.lights.Count() > 0)
            L += path.beta * SampleDirectLight(context, v, guiding, &path);
        firstHit.Light(L);

        bool isTransmission;
        if (!guiding.Scatter(v, L, sampler, &path, &isTransmission)) break;
        if ((needs & kScattersBelow) && isTransmission) [[unlikely]] {
            // Works on copies, as all that is not inlined here: what it has a pointer to would lie
            // in memory all along.
            PathContext<Media> contextBelow = context;
            Path below = path;
            Rgb sum = L;
            const bool leaves = ScatterBelow(&contextBelow, v, guiding, &below, &sum);
            context.media = contextBelow.media;
            path = below;
            L = sum;
            if (!leaves) break;
        } else {
            context.media.Leave(v, path.ray.d);
        }
        firstHit.Light(L);  // that which has been below the surface
        firstHit.Scatter(path, isTransmission);
        if (bounces > 3 && !guiding.SurvivesRoulette(scene.rrThreshold, sampler, &path)) break;
    }
    guiding.End(L);
    return L;
}

// Chooses the loop that the options and what is asked for need.
template <typename Media>
PathSample TracePath(const PathContext<Media>& context, const PathOptions& options, const Ray& ray,
                     FirstHit* firstHit) {
    const auto trace = [&](auto& guiding) {
        if (!firstHit) {
            NoFirstHit nobodyAsks;
            return Trace(context, ray, guiding, nobodyAsks);
        }
        FirstHitRecorder recorder(context.scene, options, ray.d, context.camera.time, firstHit);
        return Trace(context, ray, guiding, recorder);
    };
    if (!options.guide) {
        Unguided unguided;
        return {trace(unguided), false};
    }
    Guided guided(*options.guide, options.record, options.usual);
    const Rgb L = trace(guided);
    return {L, false, guided.Vertices()};
}

// Holds how a sample starts: dimensions that come before those of its path.
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

// Refuses what is no radiance, limits it, and applies the weights.
[[gnu::always_inline]] inline PathSample Weighted(const Scene& scene, const SampleStart& start,
                                                  PathSample sample) {
    Rgb& L = sample.radiance;
    const float luminance = Luminance(L);
    if (!IsFinite(L) || luminance < -1e-5f) return {Rgb::Zero(), true, sample.vertices};
    if (luminance > scene.film.maxSampleLuminance) L *= scene.film.maxSampleLuminance / luminance;
    L *= start.cameraWeight * start.filter.weight * scene.film.scale;
    return sample;
}

}  // namespace

PathSample RenderSample(const Scene& scene, const PathOptions& options, Sampler& sampler,
                        const Vec2i& pixel, uint32_t index, FirstHit* firstHit) {
    const SampleStart start = StartSample(scene, sampler, pixel, index);
    if (firstHit)
        *firstHit = {.weight = start.filter.weight, .offset2 = start.filter.offset.squaredNorm()};
    if (start.cameraWeight == 0) return {Rgb::Zero(), false};
    const auto trace = [&]<typename Media>(const Media& media) {
        return TracePath<Media>({scene, options.estimator, sampler, start.camera, media}, options,
                                start.ray, firstHit);
    };
    return Weighted(scene, start, scene.isVolumetric ? trace(Media(scene)) : trace(NoMedia(scene)));
}

PathLog LogSample(const Scene& scene, Estimator estimator, Sampler& sampler, const Vec2i& pixel,
                  uint32_t index) {
    const SampleStart start = StartSample(scene, sampler, pixel, index);
    PathLog log{.ray = start.ray,
                .filterWeight = start.filter.weight,
                .cameraWeight = start.cameraWeight,
                .filmScale = scene.film.scale,
                .steps = {},
                .sample = {Rgb::Zero(), false}};
    if (start.cameraWeight == 0) return log;
    const auto trace = [&]<typename Media>(const Media& media) {
        Unguided unguided;
        PathRecorder recorder(scene, &log.steps);
        return Trace(PathContext<Media>{scene, estimator, sampler, start.camera, media}, start.ray,
                     unguided, recorder);
    };
    const Rgb L = scene.isVolumetric ? trace(Media(scene)) : trace(NoMedia(scene));
    log.sample = Weighted(scene, start, {L, false});
    return log;
}

}  // namespace lull
