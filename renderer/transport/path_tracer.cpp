#include "renderer/scene/cameras/camera.h"
#include "renderer/transport/integrator_internal.h"
#include "renderer/transport/path_media.h"
#include "renderer/transport/path_state.h"

namespace lull {

// Estimates the light that arrives at a vertex of a path directly from lights.

// Returns the light that a sample of light `index` brings to the vertex, weighted against sampling
// of directions. `pmf` is the probability of having chosen the light.
template <typename Media, typename Vertex>
[[gnu::always_inline]] inline Rgb SampleLight(const PathContext<Media>& context, const Vertex& v,
                                              int index, float pmf) {
    const LightTable& lights = context.scene.lights;
    const auto light = lights.Sample(index, v.Position(), context.sampler.Get2D());
    if (!light || IsBlack(light->L)) return Rgb::Zero();
    // With a BSDF ray of its own, direct light is sampled without the specular lobes; the ray that
    // continues the path is sampled from all of them. A light that rays cannot hit keeps
    // pbrt-v3's weight in both, so that the mean stays the same.
    const bool asPbrtV3 = context.estimator == Estimator::PbrtV3;
    const bool hasOwnRay = asPbrtV3 || light->isHidden;
    const BsdfValue value = !hasOwnRay ? v.Evaluate(light->wi, LobeSet::All)
                            : asPbrtV3 ? v.Evaluate(light->wi, LobeSet::NonSpecular)
                                       : v.EvaluateEvenly(light->wi);
    if (IsBlack(value.f)) return Rgb::Zero();
    const float weight = light->isDelta ? 1
                         : hasOwnRay    ? PowerHeuristic(light->pdf, value.pdf)
                                        : PowerHeuristic(light->pdf * pmf, value.pdf);
    const float cosine = v.Cosine(light->wi);
    const Rgb L = value.f * light->L * (cosine * weight / (light->pdf * pmf));
    if constexpr (!Media::kExist) {
        if (IsBlack(L)) return Rgb::Zero();
        const auto seen = context.media.See(context, v, *light);
        Rgb arriving = L;
        if constexpr (Media::kLetThrough) {
            if (IsBlack(seen)) return Rgb::Zero();
            arriving *= seen;
        } else if (!seen) {
            return Rgb::Zero();
        }
        return light->isOnMap ? Rgb(arriving * lights.Radiance(index, *light)) : arriving;
    } else {
        const auto visibility = context.media.See(context, v, *light);
        if (IsBlack(visibility.share)) return Rgb::Zero();
        const Rgb share = light->isOnMap ? Rgb(visibility.share * lights.Radiance(index, *light))
                                         : visibility.share;
        if (light->isDelta || hasOwnRay || !visibility.isOutOfReach.any()) return L * share;
        // Light that no ray can reach keeps pbrt-v3's weight, too.
        const float evenly = PowerHeuristic(light->pdf, v.EvaluateEvenly(light->wi).pdf);
        return visibility.isOutOfReach.select(
                   value.f * light->L * (cosine * evenly / (light->pdf * pmf)), L) *
               share;
    }
}

// Returns the light that a direction sampled for it finds on light `index`: the other half of
// pbrt-v3's direct light. Takes a copy of the context, which so can stay in registers.
template <typename Media, typename Vertex>
Rgb SampleDirectionForLight(PathContext<Media> context, const Vertex& v, int index, float pmf) {
    const Vec2f u = context.sampler.Get2D();
    const Light& light = context.scene.lights[index];
    if (!IsVisible(light)) return Rgb::Zero();
    const auto sample = v.Sample(u, LobeSet::NonSpecular);
    if (!sample) return Rgb::Zero();
    LightHit lightHit;
    Rgb L;
    float lightPdf;
    if (TypeOf(light) == LightType::Infinite) {
        const Emitted found = LeAndPdf(light, v.Position(), sample->wi);
        if (found.pdf == 0 || !context.media.LeavesScene(context, v, sample->wi, &lightHit))
            return Rgb::Zero();
        L = found.L;
        lightPdf = found.pdf;
    } else {
        if (!context.media.MeetsLight(context, v, sample->wi, index, &lightHit)) return Rgb::Zero();
        const SurfaceInteraction& at = lightHit.at;
        L = Le(light, at.n, -sample->wi, lightHit.found);
        lightPdf = Pdf(light, v.Position(), at.p, at.n);
        if (lightPdf == 0) return Rgb::Zero();
    }
    return sample->f * L * lightHit.share *
           (v.Cosine(sample->wi) * PowerHeuristic(sample->pdf, lightPdf) / (sample->pdf * pmf));
}

// Samples direct light as the estimator says, after PlaceOf(): chooses one light of those at the
// vertex, tells the path how likely each was, and the recorder of its light.
template <typename Media, typename Vertex, typename Recorder>
[[gnu::always_inline]] inline Rgb SampleDirectLight(const PathContext<Media>& context,
                                                    const Vertex& v, Recorder& recorder,
                                                    Path* path) {
    path->choice = v.Choice(context.scene.lights, path->lightPlace);
    float pmf;
    const int index = path->choice.Sample(context.sampler.Get1D(), &pmf);
    if (!(pmf > 0)) return Rgb::Zero();
    Rgb L = SampleLight(context, v, index, pmf);
    if (context.estimator == Estimator::PbrtV3)
        L += SampleDirectionForLight(context, v, index, pmf);
    recorder.FindLight(*path, index, L);
    return L;
}

namespace {

enum class MediumEvent { Passes, Scatters, Ends };

// Adds the emission of the medium about a path; apart, so that a recorder changes no rounding.
template <typename Recorder>
[[gnu::noinline]] void AddEmission(int index, const Rgb& emitted, Recorder& recorder, Path* path) {
    path->L += path->beta * emitted;
    recorder.FindLight(*path, index, emitted);
}

// Follows the path's ray, which nothing else stops before `end`, through the medium about it. Where
// that scatters it, adds direct light and continues from there.
template <typename Media, typename Recorder>
[[gnu::always_inline]] inline MediumEvent FollowThroughMedium(PathContext<Media>& context,
                                                              float end, bool isLast,
                                                              Recorder& recorder, Path* path) {
    const Scene& scene = context.scene;
    const MediumSample inMedium = context.media.Sample(path->ray, end, context.sampler);
    // As in pbrt-v4, media do not emit along the last ray.
    if (scene.mediaEmit && !isLast)
        AddEmission(scene.lights.Count(), inMedium.emitted, recorder, path);
    path->beta *= inMedium.weight;
    if (IsBlack(path->beta)) return MediumEvent::Ends;
    if (!inMedium.t) return MediumEvent::Passes;
    const Vec3f p = path->ray.o + *inMedium.t * path->ray.d;
    if (!(p.squaredNorm() <= Sqr(scene.shapes.reach)))
        return MediumEvent::Ends;  // no ray starts there
    const MediumVertex v{p, -path->ray.d.normalized(), context.media.PhaseParameter()};
    path->lightPlace = scene.lights.PlaceOf(v.p);
    recorder.MeetMedium(*path, *inMedium.t, v.p);
    if (isLast) return MediumEvent::Ends;
    if (scene.lights.Count() > 0)
        path->L += path->beta * SampleDirectLight(context, v, recorder, path);
    bool isTransmission;
    if (!Scatter(v, context.sampler, path, &isTransmission)) return MediumEvent::Ends;
    recorder.Scatter(*path, true);
    return MediumEvent::Scatters;
}

// Continues the path straight on where the pane lets it pass without scattering. Returns false
// where it does not; `bsdf`, that of the vertex, is then of the light that it scatters.
template <typename Media, typename Recorder>
[[gnu::always_inline]] inline bool PassPane(PathContext<Media>& context, const SurfaceVertex& v,
                                            bool isLast, Bsdf* bsdf, Recorder& recorder,
                                            Path* path) {
    Rgb beta = path->beta;  // a copy, as the function called is not inlined
    const bool passes = GoesThroughPane(v.hit.wo, isLast, context.sampler, bsdf, &beta);
    path->beta = beta;
    if (!passes) return false;
    path->ray = v.hit.SpawnRay(path->ray.d);
    context.media.Leave(v, path->ray.d);
    recorder.Scatter(*path, true);
    return true;
}

// Continues the path, which the surface has let in, from where it leaves the solid; adds the light
// that arrives there directly. Returns false where it ends.
template <typename Media, typename Recorder>
[[gnu::noinline]] bool ScatterBelow(PathContext<Media>* context, const SurfaceVertex& v,
                                    Recorder& recorder, Path* path) {
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
    path->lightPlace = scene.lights.PlaceOf(last.hit.p);
    if (scene.lights.Count() > 0)
        path->L += path->beta * SampleDirectLight(*context, last, recorder, path);
    bool isTransmission;
    if (!Scatter(last, context->sampler, path, &isTransmission)) return false;
    context->media.Leave(last, path->ray.d);
    return true;
}

// Takes the path off the surface that has scattered it; where it `goesBelow`, off that where it
// comes out again. Returns false where it ends.
template <typename Media, typename Recorder>
[[gnu::always_inline]] inline bool LeaveSurface(PathContext<Media>& context, const SurfaceVertex& v,
                                                bool goesBelow, Recorder& recorder, Path* path) {
    if (!goesBelow) [[likely]] {
        context.media.Leave(v, path->ray.d);
        return true;
    }
    // Works on copies, as all functions not inlined here: what they point to would lie in memory.
    PathContext<Media> contextBelow = context;
    Path below = *path;
    const bool goesOn = ScatterBelow(&contextBelow, v, recorder, &below);
    context.media = contextBelow.media;
    *path = below;
    return goesOn;
}

// Follows a path along `ray`, the camera's, and returns its radiance. Compiled for each kind of
// Media and Recorder, so that what a scene does not have costs nothing.
template <typename Media, typename Recorder>
[[gnu::noinline]] Rgb Trace(PathContext<Media> context, const Ray& ray, Recorder& recorder) {
    const Scene& scene = context.scene;
    const PathIntegrator& integrator = context.integrator;
    const Estimator estimator = context.estimator;
    Sampler& sampler = context.sampler;
    const float time = context.camera.time;
    Path path{.ray = ray};
    for (int bounces = 0;; ++bounces) {
        // End where the ray could only add emission that has been counted or cannot be found.
        const bool isLast = bounces >= integrator.maxDepth;
        const bool onlyEmits = isLast && !recorder.Wanted();
        const bool emissionCounts = path.seesLights || estimator == Estimator::Combined;
        if (onlyEmits && !(emissionCounts && scene.lights.AnyVisible())) break;

        Hit found;
        const bool isHit = scene.accelerator.Intersect(path.ray, &found, time,
                                                       bounces == 0 ? kCameraRay : kOtherRay);

        if constexpr (Media::kExist) {
            const MediumEvent event = FollowThroughMedium(context, isHit ? found.t : path.ray.tMax,
                                                          isLast, recorder, &path);
            if (event == MediumEvent::Ends) break;
            if (event == MediumEvent::Scatters) {
                if (!SurvivesRoulette(context, bounces, &path)) break;
                continue;
            }
        }

        if (!isHit) {
            path.L += path.beta * Emission(scene, estimator, path, nullptr, found, recorder);
            recorder.LeaveScene(path);
            break;
        }

        path.lightPlace = scene.lights.PlaceOf(path.ray.o + found.t * path.ray.d);
        const Shape& shape = scene.shapes.shapes[found.shape];
        const SurfaceNeeds needs = scene.materials.Needs(shape.material);
        const bool endsHere = onlyEmits && !Media::LooksBehind(needs);
        if (endsHere && shape.firstLight < 0) break;
        SurfaceInteraction hit;
        scene.shapes.Interact(path.ray, found, needs, &hit, time);
        if (bounces == 0 && (needs & kNeedsFootprint) && !path.wentThrough)
            ComputeFootprint(scene.CameraOf(context.camera), context.camera, &hit);

        if (hit.areaLight >= 0)
            path.L += path.beta * Emission(scene, estimator, path, &hit, found, recorder);
        recorder.ReachSurface(path, found, hit);
        if (endsHere) break;

        if (needs & kIsInterface) {
            if (!context.media.GoThrough(hit, found.shape, isLast, &path)) break;
            recorder.Scatter(path, true);
            --bounces;
            continue;
        }

        Bsdf bsdf = scene.materials.MakeBsdf(scene.textures, &hit);
        recorder.MeetSurface(path, found, hit, bsdf);
        const SurfaceVertex v{hit, bsdf, found.shape};

        // Go straight on through a pane, which is no vertex: shadow rays pass it, too.
        if constexpr (Media::kLetThrough)
            if ((needs & kLetsThrough) && PassPane(context, v, isLast, &bsdf, recorder, &path)) {
                --bounces;
                continue;
            }
        if (isLast) break;
        if (estimator == Estimator::Combined) bsdf.ChooseByShare(hit.wo);

        if (bsdf.LobeCount(LobeSet::NonSpecular) > 0 && scene.lights.Count() > 0)
            path.L += path.beta * SampleDirectLight(context, v, recorder, &path);

        bool isTransmission;
        if (!Scatter(v, sampler, &path, &isTransmission)) break;
        const bool goesBelow = (needs & kScattersBelow) && isTransmission;
        if (!LeaveSurface(context, v, goesBelow, recorder, &path)) break;
        recorder.Scatter(path, isTransmission);

        if (!SurvivesRoulette(context, bounces, &path)) break;
    }
    recorder.End(path);
    return path.L;
}

template <typename Media>
Rgb TracePath(const PathContext<Media>& context, const PathOptions& options, const Ray& ray,
              PathSample* sample) {
    if (!FirstHitRecorder::IsNeeded(*sample)) {
        NoRecorder nobodyAsks;
        return Trace(context, ray, nobodyAsks);
    }
    FirstHitRecorder recorder(context.scene, options, ray.d, context.camera.time, sample);
    return Trace(context, ray, recorder);
}

}  // namespace

Rgb Li(const PathIntegrator& integrator, const Scene& scene, const PathOptions& options,
       Sampler& sampler, const SampleStart& start, PathSample* sample) {
    const auto trace = [&]<typename Media>(const Media& media) {
        return TracePath<Media>(
            {scene, integrator, options.estimator, sampler, start.camera, media}, options,
            start.ray, sample);
    };
    if (scene.isVolumetric) return trace(Media(scene));
    return scene.hasPanes ? trace(NoMediaButPanes(scene)) : trace(NoMedia(scene));
}

PathLog LogSample(const Scene& scene, Estimator estimator, Sampler& sampler, const Vec2i& pixel,
                  uint32_t index) {
    const SampleStart start = StartSample(scene, sampler, pixel, index);
    PathLog log{.ray = start.ray,
                .filterWeight = start.filter.weight,
                .cameraWeight = start.cameraWeight,
                .filmScale = scene.film.scale,
                .steps = {},
                .sample = {.index = index}};
    if (start.cameraWeight == 0) return log;
    const auto& integrator = std::get<PathIntegrator>(scene.integrator);
    const auto trace = [&]<typename Media>(const Media& media) {
        PathRecorder recorder(scene, &log.steps);
        return Trace(PathContext<Media>{scene, integrator, estimator, sampler, start.camera, media},
                     start.ray, recorder);
    };
    // Where there are no panes the sample is the same.
    const Rgb L = scene.isVolumetric ? trace(Media(scene)) : trace(NoMediaButPanes(scene));
    SetRadiance(scene, start, L, &log.sample);
    return log;
}

}  // namespace lull
