#include "renderer/transport/bdpt.h"

#include "renderer/base/color.h"
#include "renderer/scene/cameras/camera_view.h"
#include "renderer/scene/cameras/footprint.h"
#include "renderer/transport/bdpt_strategies_internal.h"
#include "renderer/transport/first_hit_internal.h"
#include "renderer/transport/integrator_internal.h"
#include "renderer/transport/light_subpath_internal.h"

namespace lull {
namespace {

// Returns the camera's ray as a segment, where `length` is that of its direction.
Segment SegmentFromCamera(const BdptContext& context, const Ray& ray, float length) {
    Segment segment;
    segment.ray = ray;
    if (std::abs(length - 1) > 1e-5f) segment.ray.d /= length, segment.ray.tMax *= length;
    segment.beta = Rgb::Ones();
    segment.p = ray.o;
    segment.n = segment.ray.d;
    segment.connects = false;
    if (context.lightPaths > 0)
        segment.pdf = PixelsPerSolidAngle(context.scene.camera, ray.d, context.time);
    return segment;
}

// Returns whether a subpath from the camera goes straight on through the pane at vertex v, and
// makes that segment.
template <typename Recorder>
[[gnu::always_inline]] inline bool PassesPane(const BdptContext& context, bool isLast,
                                              SubpathVertex* v, Segment* segment, Path* path,
                                              Recorder& recorder) {
    const bool goesThrough =
        GoesThroughPane(v->hit.wo, isLast, context.sampler, &v->bsdf, &v->beta);
    path->beta = segment->beta = v->beta;
    if (!goesThrough) return false;
    path->ray = segment->ray = v->hit.SpawnRay(segment->ray.d);
    recorder.Scatter(*path, true);
    return true;
}

// Connects vertex v of a subpath from the camera to those of one from a light, up to `most`. Calls
// use(light, L) with the light's number and the light L that comes to v.
template <typename Use>
[[gnu::always_inline]] inline void Connect(const BdptContext& context, const SubpathVertex& v,
                                           int most, LightSubpath* fromLight, const Use& use) {
    const SubpathVertices& vertices = fromLight->All(most);
    for (int i = 0; i < std::min(most, vertices.Count()); ++i)
        if (vertices[i].Connects())
            use(fromLight->Light(), ConnectedLight(context, v, vertices[i]));
}

// Scatters a subpath from the camera at vertex v, and ends dim ones by Russian roulette. Returns
// false where it ends.
template <typename Recorder>
[[gnu::always_inline]] inline bool GoesOn(const BdptContext& context, const SubpathVertex& v,
                                          int bounces, Segment* segment, Path* path,
                                          Recorder& recorder) {
    bool isSpecular, isTransmission;
    if (!Scatter(Origin::Camera, v, context.sampler.Get2D(), segment, &isSpecular, &isTransmission))
        return false;
    path->beta = segment->beta;
    path->ray = segment->ray;
    path->seesLights &= isSpecular;
    if (isSpecular && isTransmission) path->etaScale *= EtaScaleAt(v.hit, v.bsdf);
    recorder.Scatter(*path, isTransmission);
    if (!SurvivesRoulette(segment->beta.maxCoeff() * path->etaScale, bounces,
                          context.integrator.rrThreshold, context.sampler, &segment->beta))
        return false;
    path->beta = segment->beta;
    return true;
}

// Follows the camera's ray, and returns its radiance. `connected` receives that of connections.
template <typename Recorder>
[[gnu::noinline]] Rgb Follow(const BdptContext& context, const SampleStart& start,
                             Recorder& recorder, Rgb* connected) {
    const Scene& scene = context.scene;
    const int maxDepth = context.integrator.maxDepth;
    const bool canConnect = scene.emission->Any() && context.connections > 0;
    LightSubpath fromLight(context);
    LightChoice choice;  // at the last vertex
    // Of a camera whose transform scales, rays are not of unit length; recorders know them so.
    const float length = start.ray.d.norm();
    Segment segment = SegmentFromCamera(context, start.ray, length);
    Path path{.ray = start.ray};  // as recorders know it
    Rgb L = Rgb::Zero();          // without connections
    const auto find = [&](int light, const Rgb& found) {
        L += segment.beta * found;
        if (!IsBlack(found)) recorder.FindLight(path, light, found);
    };
    for (int bounces = 0;; ++bounces) {
        const bool isLast = bounces >= maxDepth;

        // Find the next surface, or add the light of the sky where there is none.
        Hit found;
        if (!scene.accelerator.Intersect(segment.ray, &found, context.time,
                                         bounces == 0 ? kCameraRay : kOtherRay)) {
            L += segment.beta * LeavingLight(context, segment, choice, path, recorder);
            recorder.LeaveScene(path);
            break;
        }

        // Compute the interaction with the surface, and the densities of arriving there.
        const Shape& shape = scene.shapes.shapes[found.shape];
        const SurfaceNeeds needs = scene.materials.Needs(shape.material);
        SurfaceInteraction hit;
        scene.shapes.Interact(segment.ray, found, needs, &hit, context.time);
        if (bounces == 0 && (needs & kNeedsFootprint))
            ComputeFootprint(scene.camera, start.camera, &hit);
        const Arrival arrival =
            Arrive(segment, hit.p, hit.n,
                   bounces == 0 ? context.SeenFromCamera() : context.Connected(segment.connects));
        if (!(arrival.density > 0)) break;

        // Add the emission of the surface.
        if (hit.areaLight >= 0)
            find(hit.areaLight, EmittedLight(context, segment, hit, found, arrival, choice));
        if (bounces == 0 && segment.ray.d != start.ray.d) found.t /= length;
        recorder.ReachSurface(path, found, hit);
        if (isLast && !recorder.Wanted() && !(needs & kLetsThrough)) break;

        // Make the BSDF, and go straight on through a pane, which is no vertex.
        SubpathVertex v(scene, hit, segment.beta, arrival);
        recorder.MeetSurface(path, found, v.hit, v.bsdf);
        if ((needs & kLetsThrough) && PassesPane(context, isLast, &v, &segment, &path, recorder)) {
            --bounces;
            continue;
        }
        if (isLast) break;

        // Sample the light that arrives directly from lights, and connect to a subpath from one.
        if (v.Connects() && scene.lights.Count() > 0) {
            choice = scene.lights.Choice(v.hit, v.bsdf, scene.lights.PlaceOf(v.hit.p));
            int chosen;
            const Rgb sampled = SampledLight(context, v, choice, &chosen);
            find(chosen, sampled);
            const int left = maxDepth - bounces - 1;
            if (canConnect && left > 0)
                Connect(context, v, left, &fromLight, [&](int light, const Rgb& found) {
                    *connected += v.beta * found;
                    recorder.FindLight(path, light, found);
                });
        }

        // Sample the direction in which the subpath goes on, unless roulette ends it.
        if (!GoesOn(context, v, bounces, &segment, &path, recorder)) break;
    }
    recorder.End(path);
    return L + *connected;
}

}  // namespace

Rgb Li(const BdptIntegrator&, const Scene& scene, const PathOptions& options, Sampler& sampler,
       const SampleStart& start, PathSample* sample) {
    const BdptContext context = ContextOf(scene, options.shares, sampler, start.camera.time);
    Rgb connected = Rgb::Zero();
    const auto follow = [&](auto recorder) {
        const Rgb L = Follow(context, start, recorder, &connected);
        const float luminance = Luminance(L);
        if (luminance > 0) sample->connected = Luminance(connected) / luminance;
        return L;
    };
    if (!FirstHitRecorder::IsNeeded(*sample)) return follow(NoRecorder());
    return follow(FirstHitRecorder(scene, options, start.ray.d, start.camera.time, sample));
}

}  // namespace lull
