// What bidirectional path tracing knows of a sample, or of a light path.
#pragma once

#include <new>

#include "renderer/scene/lights/light_emission.h"
#include "renderer/transport/bdpt.h"
#include "renderer/transport/path_media.h"
#include "renderer/transport/path_state.h"

namespace lull {

// Subpaths of bidirectional path tracing, from the camera or from a light, and the weights of the
// ways in which a path can be put together from two of them.
//
// A path of k vertices is found by k + 1 strategies: with s vertices from a light and t = k - s
// from the camera. Veach's power heuristic (1997, section 9.2; exponent 2) weighs one by n_i p_i,
// the samples that it takes times its density. Sums over the strategies of fewer vertices on one's
// own side follow from vertex to vertex (van Antwerpen 2011; Georgiev 2012), so that a weight costs
// the same at any length. With P(i) the density of vertex i by area from its own side, and Q(i)
// that from the other side,
//
//     sum(i) = (Q(i) / P(i))^2 [c(i) + (Q(i-1) / P(i-1))^2 [c(i-1) + ...]],
//
// where c(i) is n^2 of the strategy that has i vertices on this side, 0 if one of the two vertices
// that it connects scatters into one direction only.

// The way of a subpath from its last vertex to the next.
struct Segment {
    Ray ray;               // of unit direction
    Rgb beta;              // radiance, or power, over the density of the subpath
    float pdf = 1;         // of the direction, 1/sr; from lights at infinity 1/m^2 across it
    Vec3f p, n;            // the last vertex; n zero if it has none
    double density = 1;    // P of the last vertex
    double sum = 0;        // c(i) + (Q(i-1) / P(i-1))^2 [...] of the last vertex
    bool connects = true;  // the last vertex scatters into more than one direction
    bool fromInfinity = false;
};

// Densities of a vertex at which a subpath arrives.
struct Arrival {
    double density = 0;  // P(i)
    double own = 0;      // c(i), if the vertex itself can be connected
    double fewer = 0;    // times the square of the density, 1/sr, of going back: the rest
    // Returns sum(i) / Q(i)^2, where `back` is that density.
    double Sum(float back) const { return (own + Sqr(double(back)) * fewer) / Sqr(density); }
};

// Returns the factor from a density by solid angle to one by area at a point of normal n.
inline double PerArea(const Vec3f& n, const Vec3f& d, double distance2) {
    return std::abs(double(n.dot(d))) / distance2;
}

// Arrives at the surface that the segment's ray meets. `own` is c(i).
inline Arrival Arrive(const Segment& segment, const Vec3f& p, const Vec3f& n, double own) {
    const double distance2 = std::max(double((p - segment.p).squaredNorm()), 1e-30);
    const Vec3f& d = segment.ray.d;
    const double across = std::abs(double(n.dot(d)));
    const double back = segment.fromInfinity ? 1 : PerArea(segment.n, d, distance2);
    Arrival arrival;
    arrival.density = double(segment.pdf) * (segment.fromInfinity ? across : across / distance2);
    arrival.own = own;
    arrival.fewer = Sqr(back / segment.density) * segment.sum;
    return arrival;
}

// A surface where a subpath scatters.
struct SubpathVertex {
    SurfaceInteraction hit;  // wo points back along the subpath
    Bsdf bsdf;
    Rgb beta;
    Arrival arrival;

    SubpathVertex(const Scene& scene, const SurfaceInteraction& at, const Rgb& beta,
                  const Arrival& arrival)
        : hit(at),
          bsdf(scene.materials.MakeBsdf(scene.textures, &hit)),
          beta(beta),
          arrival(arrival) {}

    bool Connects() const { return bsdf.LobeCount(LobeSet::NonSpecular) > 0; }

    // Returns the density of wi for light or importance that comes from wo.
    float Pdf(const Vec3f& wo, const Vec3f& wi) const {
        return bsdf.Evaluate(wo, wi, LobeSet::All).pdf;
    }

    // Return f times cosines for the ways from the camera and from a light: light that arrives from
    // wi along wo, with the density of wi; and light that has come from wo along wi, by the square
    // of the indices' ratio and the normals of shading (Veach 1997, 5.3.2), with the density of
    // going from wi to wo.
    BsdfValue TowardsLight(const Vec3f& wi) const {
        BsdfValue value = bsdf.Evaluate(hit.wo, wi, LobeSet::All);
        value.f *= std::abs(wi.dot(hit.ns));
        return value;
    }
    BsdfValue TowardsCamera(const Vec3f& wi) const {
        BsdfValue value = bsdf.Evaluate(wi, hit.wo, LobeSet::All);
        value.f *= ShadingFactor() * std::abs(wi.dot(hit.n));
        return value;
    }
    float ShadingFactor() const {
        const float cosine = std::abs(hit.wo.dot(hit.n));
        return cosine > 0 ? std::abs(hit.wo.dot(hit.ns)) / cosine : 0;
    }
};

// Whether a subpath comes from the camera, and carries importance, or from a light.
enum class Origin { Camera, Light };

// Scatters a subpath at a vertex: makes the segment to the next. Returns false where it ends.
bool Scatter(Origin, const SubpathVertex&, const Vec2f& u, Segment*, bool* isSpecular,
             bool* isTransmission);

// Returns the share of light that gets from one point of a surface to another.
Rgb ShareBetween(const Scene&, const SurfaceInteraction& a, const SurfaceInteraction& b,
                 float time);

// Ends dim subpaths at random as paths end by Estimator::Combined; `brightest` is their throughput.
// Returns false where it ends.
bool SurvivesRoulette(float brightest, int bounces, float threshold, Sampler& sampler, Rgb* beta);

// Its referents must outlive it.
struct BdptContext {
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

// The most vertices of a subpath from a light.
inline constexpr int kMostVertices = BdptIntegrator::kMostBounces;

// Returns the context of a scene with a BdptIntegrator.
inline BdptContext ContextOf(const Scene& scene, const BdptShares& shares, Sampler& sampler,
                             float time) {
    return {scene,
            std::get<BdptIntegrator>(scene.integrator),
            sampler,
            time,
            LightPathCount(scene, shares),
            double(shares.connections)};
}

// The light that each strategy of bidirectional path tracing finds at a subpath from the camera,
// with its weight among all strategies (power heuristic).

// Returns the weight of light that the ray of a camera's subpath has found, of density `origin`
// among those of emitted light. `direct` is the density, 1/sr, of sampling it at the last vertex.
double EmissionWeight(const Segment& segment, double density, double fewer, float direct,
                      const EmissionDensity& emission);

// Returns the light of the surface, a light's, weighted.
Rgb EmittedLight(const BdptContext& context, const Segment& segment, const SurfaceInteraction& hit,
                 const Hit& found, const Arrival& arrival, const LightChoice& choice);

// Returns the light that sampling a light, whose number `chosen` receives, brings to the vertex.
Rgb SampledLight(const BdptContext& context, const SubpathVertex& v, const LightChoice& choice,
                 int* chosen);

// Returns the light that goes from vertex y of a subpath from a light to z, one from the camera's.
Rgb ConnectedLight(const BdptContext& context, const SubpathVertex& z, const SubpathVertex& y);

// Returns the light of the sky that leaves the scene, weighted; tells the recorder of each light.
template <typename Recorder>
Rgb LeavingLight(const BdptContext& context, const Segment& segment, const LightChoice& choice,
                 const Path& path, Recorder& recorder) {
    const Scene& scene = context.scene;
    Rgb sum = Rgb::Zero();
    for (const int i : scene.lights.Infinite()) {
        const auto [L, pdf] = LeAndPdf(scene.lights[i], segment.ray.o, segment.ray.d);
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

// Subpaths from lights.

// The vertices of a subpath, without allocations.
class SubpathVertices {
  public:
    SubpathVertices() = default;
    SubpathVertices(const SubpathVertices&) = delete;
    SubpathVertices& operator=(const SubpathVertices&) = delete;

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
    alignas(SubpathVertex) std::byte storage[kMostVertices * sizeof(SubpathVertex)];
};

// Returns the ratio of the density of sampling the point, or direction, of a light from vertex v
// over the density with which the light starts paths there.
double DirectOverEmitted(const Scene& scene, const SubpathVertex& v, const EmittedRay& ray);

// Follows light from a light; calls visit(vertex, hit, light) with each surface that it comes to,
// of as many bounces at most, where `place` makes the vertex of the hit, and with the light's
// number.
template <typename Place, typename Visit>
void FollowLight(const BdptContext& context, int mostBounces, const Place& place,
                 const Visit& visit) {
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

// The subpath from a light that belongs to a sample, traced when it is first asked for.
class LightSubpath {
  public:
    explicit LightSubpath(const BdptContext& context) : context(context) {}

    // Returns all vertices, of which there may be `mostBounces` at most the first time.
    const SubpathVertices& All(int mostBounces) {
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
    const BdptContext& context;
    bool isTraced = false;
    int light = 0;
    SubpathVertices vertices;
};

}  // namespace lull
