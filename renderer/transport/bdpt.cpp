#include "renderer/transport/bdpt.h"

#include "renderer/base/math.h"
#include "renderer/scene/cameras/camera.h"
#include "renderer/transport/bdpt_internal.h"
#include "renderer/transport/integrator_internal.h"
#include "renderer/transport/path_media.h"
#include "renderer/transport/path_state.h"

namespace lull {
namespace {

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

// Scatters a camera's subpath at v, and ends dim ones by Russian roulette: returns false.
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

        Hit found;
        if (!scene.accelerator.Intersect(segment.ray, &found, context.time,
                                         bounces == 0 ? kCameraRay : kOtherRay)) {
            L += segment.beta * LeavingLight(context, segment, choice, path, recorder);
            recorder.LeaveScene(path);
            break;
        }

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

        if (hit.areaLight >= 0)
            find(hit.areaLight, EmittedLight(context, segment, hit, found, arrival, choice));
        if (bounces == 0 && segment.ray.d != start.ray.d) found.t /= length;
        recorder.ReachSurface(path, found, hit);
        if (isLast && !recorder.Wanted() && !(needs & kLetsThrough)) break;

        SubpathVertex v(scene, hit, segment.beta, arrival);
        recorder.MeetSurface(path, found, v.hit, v.bsdf);
        if ((needs & kLetsThrough) && PassesPane(context, isLast, &v, &segment, &path, recorder)) {
            --bounces;
            continue;
        }
        if (isLast) break;

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

double EmissionWeight(const Segment& segment, double density, double fewer, float direct,
                      const EmissionDensity& emission) {
    const double sampled = segment.connects ? double(direct) / double(segment.pdf) : 0;
    const double fromLight = double(emission.origin) * double(emission.onward) / density;
    return 1 / (1 + Sqr(sampled) + Sqr(fromLight) * fewer);
}

Rgb EmittedLight(const BdptContext& context, const Segment& segment, const SurfaceInteraction& hit,
                 const Hit& found, const Arrival& arrival, const LightChoice& choice) {
    const Scene& scene = context.scene;
    const Light& light = scene.lights[hit.areaLight];
    const Rgb L = Le(light, hit.n, hit.wo, found);
    if (IsBlack(L)) return L;
    const float direct =
        segment.connects ? Pdf(light, segment.p, hit.p, hit.n) * choice.Pmf(hit.areaLight) : 0;
    return L * float(EmissionWeight(segment, arrival.density, arrival.fewer, direct,
                                    scene.emission->Density(hit.areaLight, hit.n, hit.wo)));
}

Rgb SampledLight(const BdptContext& context, const SubpathVertex& v, const LightChoice& choice,
                 int* chosen) {
    const Scene& scene = context.scene;
    float pmf;
    const int index = *chosen = choice.Sample(context.sampler.Get1D(), &pmf);
    const Vec2f u = context.sampler.Get2D();
    if (!(pmf > 0)) return Rgb::Zero();
    const auto light = scene.lights.Sample(index, v.hit.p, u);
    if (!light || IsBlack(light->L)) return Rgb::Zero();
    const BsdfValue value = v.TowardsLight(light->wi);
    if (IsBlack(value.f)) return Rgb::Zero();
    const auto ray = ShadowRay(v.hit, *light);
    const Rgb share = ray ? ShareAlong(scene, *ray, context.time) : Rgb(Rgb::Zero());
    if (IsBlack(share)) return Rgb::Zero();
    const Rgb L = share * (light->isOnMap ? scene.lights.Radiance(index, *light) : light->L);

    const double direct = double(light->pdf) * double(pmf);
    const double found = light->isDelta || light->isHidden ? 0 : double(value.pdf) / direct;
    const EmissionDensity emission = scene.emission->Density(index, light->n, -light->wi);
    const double across = std::abs(double(v.hit.n.dot(light->wi)));
    double more = double(emission.origin) / direct * double(emission.onward) * across;
    if (!light->isAtInfinity) {
        const double distance2 = std::max(double((light->p - v.hit.p).squaredNorm()), 1e-30);
        // A density by solid angle, of light that has an area.
        if (!light->isDelta) more /= PerArea(light->n, light->wi, distance2);
        more /= distance2;
    }
    if (more > 0) more = Sqr(more) * v.arrival.Sum(v.Pdf(light->wi, v.hit.wo));
    const double weight = 1 / (1 + Sqr(found) + more);
    return value.f * L * float(weight / direct);
}

Rgb ConnectedLight(const BdptContext& context, const SubpathVertex& z, const SubpathVertex& y) {
    const Vec3f d = y.hit.p - z.hit.p;
    const float distance2 = d.squaredNorm();
    if (!(distance2 > 0)) return Rgb::Zero();
    const Vec3f w = d / std::sqrt(distance2);
    const BsdfValue atZ = z.TowardsLight(w);
    if (IsBlack(atZ.f)) return Rgb::Zero();
    const BsdfValue atY = y.TowardsCamera(-w);
    Rgb L = atZ.f * atY.f * y.beta / distance2;
    if (IsBlack(L)) return Rgb::Zero();
    L *= ShareBetween(context.scene, z.hit, y.hit, context.time);
    if (IsBlack(L)) return Rgb::Zero();
    const double towardsY = double(atZ.pdf) * PerArea(y.hit.n, w, double(distance2));
    const double towardsZ = double(y.Pdf(y.hit.wo, -w)) * PerArea(z.hit.n, w, double(distance2));
    double others = 0;
    if (towardsY > 0) others += Sqr(towardsY) * y.arrival.Sum(atY.pdf);
    if (towardsZ > 0) others += Sqr(towardsZ) * z.arrival.Sum(z.Pdf(w, z.hit.wo));
    const double samples = context.connections;
    return L * float(samples / (Sqr(samples) + others));
}

}  // namespace lull
