#include "renderer/transport/bdpt.h"

#include "renderer/base/color.h"
#include "renderer/scene/cameras/camera_view.h"
#include "renderer/scene/cameras/footprint.h"
#include "renderer/transport/first_hit_internal.h"
#include "renderer/transport/integrator_internal.h"
#include "renderer/transport/path_media.h"
#include "renderer/transport/subpath.h"

namespace lull {
namespace {

// Constants of a sample, or of a light path.
struct Context {
    const Scene& scene;
    const BdptIntegrator& integrator;
    Sampler& sampler;
    float time;
    double lightPaths;   // for each sample of all pixels
    double connections;  // the probability of a subpath from a light

    // Return c(1) of subpaths from the camera, and c(i) of all others beyond.
    double SeenFromCamera() const { return Sqr(lightPaths); }
    double Connected(bool connects) const { return connects ? Sqr(connections) : 0; }
};

// The vertices of a subpath, without allocations.
class Vertices {
  public:
    static constexpr int kMost = BdptIntegrator::kMostBounces;

    Vertices() = default;
    Vertices(const Vertices&) = delete;
    Vertices& operator=(const Vertices&) = delete;

    template <typename... Arguments>
    SubpathVertex& Add(Arguments&&... arguments) {
        return *new (&storage[size_t(count++) * sizeof(SubpathVertex)])
            SubpathVertex(std::forward<Arguments>(arguments)...);
    }
    int Count() const { return count; }
    const SubpathVertex& operator[](int i) const {
        return *std::launder(
            reinterpret_cast<const SubpathVertex*>(&storage[size_t(i) * sizeof(SubpathVertex)]));
    }

  private:
    static_assert(std::is_trivially_destructible_v<SubpathVertex>);
    int count = 0;
    alignas(SubpathVertex) std::byte storage[kMost * sizeof(SubpathVertex)];
};

// Returns the ratio of the density of sampling the point, or direction, of a light from vertex v
// over the density with which the light starts paths there.
double DirectOverEmitted(const Scene& scene, const SubpathVertex& v, const EmittedRay& ray) {
    const Light& light = scene.lights[ray.light];
    const float pmf =
        scene.lights.Choice(v.hit, v.bsdf, scene.lights.PlaceOf(v.hit.p)).Pmf(ray.light);
    const LightType type = TypeOf(light);
    double density = pmf;
    if (type == LightType::Area) {
        const Vec3f d = ray.p - v.hit.p;
        const double distance2 = std::max(double(d.squaredNorm()), 1e-30);
        density *= double(Pdf(light, v.hit.p, ray.p, ray.n)) *
                   PerArea(ray.n, d / std::sqrt(float(distance2)), distance2);
    } else if (type == LightType::Infinite) {
        density *= double(LeAndPdf(light, -ray.w).pdf);
    }
    return density / double(ray.density.origin);
}

// Follows light from a light; calls visit(vertex, hit, light) with each surface that it comes to,
// of as many bounces at most, where `place` makes the vertex of the hit, and with the light's
// number.
template <typename Place, typename Visit>
void FollowLight(const Context& context, int mostBounces, const Place& place, const Visit& visit) {
    const Scene& scene = context.scene;
    Sampler& sampler = context.sampler;
    const float u = sampler.Get1D();
    const Vec2f origin = sampler.Get2D(), direction = sampler.Get2D();
    const auto emitted = scene.emission->Sample(u, origin, direction);
    if (!emitted || mostBounces < 1) return;
    Segment segment;
    segment.ray = {OffsetRayOrigin(emitted->p, emitted->pError, emitted->n, emitted->w), emitted->w,
                   kInfinity};
    segment.beta = emitted->Power();
    segment.pdf = emitted->density.onward;
    segment.p = emitted->p;
    segment.n = emitted->n;
    segment.density = double(emitted->density.origin);
    segment.sum = IsVisible(scene.lights[emitted->light]) ? 1 : 0;
    segment.fromInfinity = emitted->isAtInfinity;
    const float brightest = segment.beta.maxCoeff();
    for (int bounces = 1;; ++bounces) {
        Hit found;
        if (!scene.accelerator.Intersect(segment.ray, &found, context.time)) return;
        SurfaceInteraction hit;
        const Shape& shape = scene.shapes.shapes[found.shape];
        const SurfaceNeeds needs = scene.materials.Needs(shape.material);
        scene.shapes.Interact(segment.ray, found, needs, &hit, context.time);
        if (needs & kLetsThrough) {
            SurfaceInteraction at = hit;  // which bump maps turn
            Bsdf bsdf = scene.materials.MakeBsdf(scene.textures, &at);
            if (GoesThroughPane(hit.wo, false, sampler, &bsdf, &segment.beta)) {
                segment.ray = hit.SpawnRay(segment.ray.d);
                --bounces;
                continue;
            }
        }
        Arrival arrival = Arrive(segment, hit.p, hit.n, context.Connected(segment.connects));
        if (!(arrival.density > 0)) return;
        SubpathVertex& v = place(hit, segment.beta, arrival);
        if (needs & kLetsThrough) v.bsdf.BlockStraight();
        if (bounces == 1) v.arrival.own = Sqr(DirectOverEmitted(scene, v, *emitted));
        visit(v, hit, emitted->light);
        if (bounces == mostBounces) return;
        bool isSpecular, isTransmission;
        if (!Scatter(Origin::Light, v, sampler.Get2D(), &segment, &isSpecular, &isTransmission) ||
            !SurvivesRoulette(segment.beta.maxCoeff() / brightest, bounces,
                              context.integrator.rrThreshold, sampler, &segment.beta))
            return;
    }
}

// Returns the weight of light that the ray of a camera's subpath has found, of density `origin`
// among those of emitted light. `direct` is the density, 1/sr, of sampling it at the last vertex.
double EmissionWeight(const Segment& segment, double density, double fewer, float direct,
                      const EmissionDensity& emission) {
    const double sampled = segment.connects ? double(direct) / double(segment.pdf) : 0;
    const double fromLight = double(emission.origin) * double(emission.onward) / density;
    return 1 / (1 + Sqr(sampled) + Sqr(fromLight) * fewer);
}

// Returns the light of the sky that leaves the scene, weighted; tells the recorder of each light.
template <typename Recorder>
Rgb LeavingLight(const Context& context, const Segment& segment, const LightChoice& choice,
                 const Path& path, Recorder& recorder) {
    const Scene& scene = context.scene;
    Rgb sum = Rgb::Zero();
    for (const int i : scene.lights.Infinite()) {
        const auto [L, pdf] = LeAndPdf(scene.lights[i], segment.ray.d);
        if (IsBlack(L)) continue;
        const double across = std::abs(double(segment.n.dot(segment.ray.d)));
        const double fewer = Sqr(across / segment.density) * segment.sum;
        const float direct = segment.connects ? pdf * choice.Pmf(i) : 0;
        const Rgb weighted =
            L * float(EmissionWeight(segment, double(segment.pdf), fewer, direct,
                                     scene.emission->Density(i, Vec3f::Zero(), -segment.ray.d)));
        sum += weighted;
        recorder.FindLight(path, i, weighted);
    }
    return sum;
}

// Returns the light of the surface, a light's, weighted.
Rgb EmittedLight(const Context& context, const Segment& segment, const SurfaceInteraction& hit,
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

// Returns the light that sampling a light, whose number `chosen` receives, brings to the vertex.
Rgb SampledLight(const Context& context, const SubpathVertex& v, const LightChoice& choice,
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

// Returns the light that goes from vertex y of a subpath from a light to z, one from the camera's.
Rgb ConnectedLight(const Context& context, const SubpathVertex& z, const SubpathVertex& y) {
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

// The subpath from a light that belongs to a sample, traced when it is first asked for.
class LightSubpath {
  public:
    explicit LightSubpath(const Context& context) : context(context) {}

    // Returns all vertices, of which there may be `mostBounces` at most the first time.
    const Vertices& All(int mostBounces) {
        if (isTraced) return vertices;
        isTraced = true;
        const bool isChosen =
            context.connections >= 1 || double(context.sampler.Get1D()) < context.connections;
        if (!isChosen) return vertices;
        FollowLight(
            context, mostBounces,
            [&](const SurfaceInteraction& hit, const Rgb& beta, const Arrival& arrival)
                -> SubpathVertex& { return vertices.Add(context.scene, hit, beta, arrival); },
            [&](const SubpathVertex&, const SurfaceInteraction&, int index) { light = index; });
        return vertices;
    }
    int Light() const { return light; }  // its number, where there are vertices

  private:
    const Context& context;
    bool isTraced = false;
    int light = 0;
    Vertices vertices;
};

// Returns the camera's ray as a segment, where `length` is that of its direction.
Segment SegmentFromCamera(const Context& context, const Ray& ray, float length) {
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
[[gnu::always_inline]] inline bool PassesPane(const Context& context, bool isLast, SubpathVertex* v,
                                              Segment* segment, Path* path, Recorder& recorder) {
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
[[gnu::always_inline]] inline void Connect(const Context& context, const SubpathVertex& v, int most,
                                           LightSubpath* fromLight, const Use& use) {
    const Vertices& vertices = fromLight->All(most);
    for (int i = 0; i < std::min(most, vertices.Count()); ++i)
        if (vertices[i].Connects())
            use(fromLight->Light(), ConnectedLight(context, v, vertices[i]));
}

// Scatters a subpath from the camera at vertex v, and ends dim ones by Russian roulette. Returns
// false where it ends.
template <typename Recorder>
[[gnu::always_inline]] inline bool GoesOn(const Context& context, const SubpathVertex& v,
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
[[gnu::noinline]] Rgb Follow(const Context& context, const SampleStart& start, Recorder& recorder,
                             Rgb* connected) {
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
        if (!scene.accelerator.Intersect(segment.ray, &found, context.time)) {
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

double LightPathCount(const Scene& scene, const BdptShares& shares) {
    if (!SeesPoints(scene.camera) || !scene.emission || !scene.emission->Any()) return 0;
    const Vec2i& size = scene.film.resolution;
    return std::ceil(double(shares.lightPaths) * double(size.x()) * double(size.y()));
}

Rgb Li(const BdptIntegrator& integrator, const Scene& scene, const PathOptions& options,
       Sampler& sampler, const SampleStart& start, const SampleDetail& detail) {
    const Context context{scene,
                          integrator,
                          sampler,
                          start.camera.time,
                          LightPathCount(scene, options.shares),
                          double(options.shares.connections)};
    Rgb connected = Rgb::Zero();
    const auto follow = [&](auto recorder) {
        const Rgb L = Follow(context, start, recorder, &connected);
        const float luminance = Luminance(L);
        if (detail.counts && luminance > 0)
            detail.counts->connected = Luminance(connected) / luminance;
        return L;
    };
    if (!detail.firstHit && !detail.groups) return follow(NoRecorder());
    FirstHit unseen;
    const FirstHitRecorder firstHit(scene, options, start.ray.d, start.camera.time,
                                    detail.firstHit ? detail.firstHit : &unseen);
    if (!detail.groups) return follow(firstHit);
    return follow(GroupRecorder(firstHit, detail.groups));
}

namespace {

// Connects vertices of a light path to the camera.
class CameraConnector {
  public:
    CameraConnector(const Context& context, std::vector<Splat>* splats)
        : context(context),
          splats(splats),
          size(context.scene.film.resolution.cast<float>()),
          reach(context.scene.filter.Radius()) {}

    // The light is number `light`.
    void Connect(const SubpathVertex& v, const SurfaceInteraction& hit, int light) {
        if (!v.Connects()) return;
        const Scene& scene = context.scene;
        CameraSample at;
        at.time = context.time;
        if (scene.camera.HasLens()) at.lens = context.sampler.Get2D();
        const auto view = ViewOf(scene.camera, hit.p, at.lens, at.time);
        if (!view || (view->film.array() < -reach.array()).any() ||
            (view->film.array() > (size + reach).array()).any())
            return;
        at.film = view->film;
        if (!(scene.materials.Needs(hit.material) & kNeedsFootprint)) return Add(v, *view, light);
        SurfaceInteraction seen = hit;
        ComputeFootprint(scene.camera, at, &seen);
        Add(SubpathVertex(scene, seen, v.beta, v.arrival), *view, light);
    }

  private:
    void Add(const SubpathVertex& v, const CameraView& view, int light) {
        const Scene& scene = context.scene;
        const Vec3f d = view.lens - v.hit.p;
        const float distance2 = d.squaredNorm();
        const Vec3f w = d / std::sqrt(distance2);
        const BsdfValue value = v.TowardsCamera(w);
        Rgb L = value.f * v.beta * (view.perSolidAngle / distance2);
        if (IsBlack(L)) return;
        const Vec3f origin = OffsetRayOrigin(v.hit.p, v.hit.pError, v.hit.n, w);
        L *= ShareAlong(scene, {origin, view.lens - origin, 1}, context.time);
        if (IsBlack(L)) return;
        const double seen = double(view.perSolidAngle) * PerArea(v.hit.n, w, double(distance2));
        const double samples = context.lightPaths;
        L *= float(samples / (Sqr(samples) + Sqr(seen) * v.arrival.Sum(value.pdf)));
        const float luminance = Luminance(L);
        if (luminance > scene.film.maxSampleLuminance)
            L *= scene.film.maxSampleLuminance / luminance;
        L *= scene.film.scale;
        const bool isValid = IsFinite(L) && luminance >= 0;
        splats->push_back({view.film, isValid ? L : Rgb(Rgb::Zero()), light, !isValid});
    }

    const Context& context;
    std::vector<Splat>* splats;
    const Vec2f size, reach;  // of the image and the filter, pixels
};

}  // namespace

void TraceLightPath(const Scene& scene, const BdptShares& shares, Sampler& sampler, uint32_t round,
                    uint32_t index, std::vector<Splat>* splats) {
    splats->clear();
    // Numbers of no pixel: one Sobol sequence for each round.
    sampler.StartSample(Vec2i(-1, int(round)), index);
    const float time = scene.isMoving ? sampler.Get1D() : 0;
    const Context context{scene,
                          std::get<BdptIntegrator>(scene.integrator),
                          sampler,
                          time,
                          LightPathCount(scene, shares),
                          double(shares.connections)};
    CameraConnector connector(context, splats);
    alignas(SubpathVertex) std::byte storage[sizeof(SubpathVertex)];
    FollowLight(
        context, context.integrator.maxDepth,
        [&](const SurfaceInteraction& hit, const Rgb& beta, const Arrival& arrival)
            -> SubpathVertex& { return *new (storage) SubpathVertex(scene, hit, beta, arrival); },
        [&](const SubpathVertex& v, const SurfaceInteraction& hit, int light) {
            connector.Connect(v, hit, light);
        });
}

}  // namespace lull
