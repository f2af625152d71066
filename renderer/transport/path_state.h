// A path between two vertices, and its way from one to the next.
#pragma once

#include <array>
#include <utility>

#include "renderer/base/math.h"
#include "renderer/base/sampling.h"
#include "renderer/bsdf/bsdf.h"
#include "renderer/bsdf/subsurface.h"
#include "renderer/scene/scene.h"
#include "renderer/transport/integrator.h"

namespace lull {

// Recorders, which are told of a path's vertices. The loop over a path is compiled for each of
// them, so that where none is needed there is not even a branch.

struct Path;

// The default for all callbacks: records nothing.
struct NoRecorder {
    // Whether a path at its greatest depth has to continue for the recorder.
    static constexpr bool Wanted() { return false; }
    // The path, of this throughput, has found light of light `index`: that of a sample of it, or
    // its emission. Behind the last one are media.
    static void FindLight(const Path&, int, const Rgb&) {}
    // The path's ray, of unit direction, ends: it leaves the scene, is at a surface whose BSDF is
    // not yet known, or is scattered by a medium at p, at this distance. The path has found the
    // emission there.
    static void LeaveScene(const Path&) {}
    static void ReachSurface(const Path&, const Hit&, const SurfaceInteraction&) {}
    static void MeetMedium(const Path&, float, const Vec3f&) {}
    // It has come to a surface of this BSDF.
    static void MeetSurface(const Path&, const Hit&, const SurfaceInteraction&, const Bsdf&) {}
    // It is scattered; `isTransmission`: through the surface, or medium.
    static void Scatter(const Path&, bool) {}
    static void End(const Path&) {}
};

// Where a path scatters: on a surface, or in a medium. Directions point away, unit, world.

// Returns whether both directions leave a surface of normal n on the same side.
inline bool IsSameSide(const Vec3f& n, const Vec3f& a, const Vec3f& b) {
    return (a.dot(n) < 0) == (b.dot(n) < 0);
}

// Returns the factor of radiance that is refracted from wo's side of a surface to the other.
inline float EtaScaleAt(const SurfaceInteraction& hit, const Bsdf& bsdf) {
    const float eta2 = Sqr(bsdf.Eta());
    return hit.wo.dot(hit.n) > 0 ? eta2 : 1 / eta2;
}

struct SurfaceVertex {
    const SurfaceInteraction& hit;
    const Bsdf& bsdf;
    int shape;

    const Vec3f& Position() const { return hit.p; }
    LightChoice Choice(const LightTable& lights, size_t place) const {
        return lights.Choice(hit, bsdf, place);
    }

    BsdfValue Evaluate(const Vec3f& wi, LobeSet set) const {
        return bsdf.Evaluate(hit.wo, wi, set);
    }
    // Does so without specular lobes, with the density that all others are as likely.
    BsdfValue EvaluateEvenly(const Vec3f& wi) const {
        return bsdf.WithoutShares().Evaluate(hit.wo, wi, LobeSet::NonSpecular);
    }
    std::optional<BsdfSample> Sample(const Vec2f& u, LobeSet set) const {
        return bsdf.Sample(hit.wo, u, set);
    }
    float Cosine(const Vec3f& wi) const { return std::abs(wi.dot(hit.ns)); }

    // Returns the point where a ray of direction d, of any length, starts.
    Vec3f OriginTowards(const Vec3f& d) const {
        return OffsetRayOrigin(hit.p, hit.pError, hit.n, d);
    }
    Ray SpawnRay(const Vec3f& d) const { return hit.SpawnRay(d); }
    float EtaScale() const { return EtaScaleAt(hit, bsdf); }
    bool IsSameSide(const Vec3f& a, const Vec3f& b) const { return lull::IsSameSide(hit.n, a, b); }
};

// f is the phase function, which is its density as well.
struct MediumVertex {
    Vec3f p, wo;
    float g;

    const Vec3f& Position() const { return p; }
    LightChoice Choice(const LightTable& lights, size_t place) const {
        return lights.Choice(p, place);
    }

    BsdfValue Evaluate(const Vec3f& wi, LobeSet) const {
        const float phase = PhaseHenyeyGreenstein(wo.dot(wi), g);
        return {Rgb::Constant(phase), phase};
    }
    BsdfValue EvaluateEvenly(const Vec3f& wi) const { return Evaluate(wi, LobeSet::All); }
    std::optional<BsdfSample> Sample(const Vec2f& u, LobeSet) const {
        const Vec3f wi = SampleHenyeyGreenstein(wo, g, u);
        const BsdfValue value = Evaluate(wi, LobeSet::All);
        return BsdfSample{value.f, value.pdf, wi, false, true};
    }
    float Cosine(const Vec3f&) const { return 1; }
    float EtaScale() const { return 1; }

    Vec3f OriginTowards(const Vec3f&) const { return p; }
    Ray SpawnRay(const Vec3f& d) const { return {p, d, kInfinity}; }
    bool IsSameSide(const Vec3f&, const Vec3f&) const { return true; }
};

// Constants of a path and, in `media`, that of its next ray: a policy (path_media.h).
template <typename Media>
struct PathContext {
    const Scene& scene;
    const PathIntegrator& integrator;
    Estimator estimator;
    Sampler& sampler;
    const CameraSample& camera;
    Media media;
};

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
            const auto [L, pdf] = LeAndPdf(scene.lights[i], path.ray.o, path.ray.d);
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

// Records the first hit of a path, and the light of groups.

// Returns the number of the hit object, as in FirstHit.
inline uint32_t NumberOfObject(const Scene& scene, const Hit& found) {
    return 1 + uint32_t(found.instance < 0 ? found.shape
                                           : scene.shapes.worldShapeCount + found.instance);
}

class FirstHitRecorder : public NoRecorder {
  public:
    // Records what the sample asks for. `direction` is of the camera's ray at `time`.
    FirstHitRecorder(const Scene& scene, const PathOptions& options, const Vec3f& direction,
                     float time, PathSample* sample)
        : scene(scene),
          options(options),
          direction(direction),
          time(time),
          groups(sample->groups),
          hits{{{sample->asksForHit ? &sample->hit : nullptr, options.throughSpecular},
                {sample->asksForFeatures ? &sample->features : nullptr, true}}} {}
    static bool IsNeeded(const PathSample& sample) { return sample.AsksForHits() || sample.groups; }

    bool Wanted() const { return IsDue(false); }

    void FindLight(const Path& path, int index, const Rgb& L) {
        if (groups) groups->Add(index, path.beta * L);
    }

    // The environment's radiance stands for the albedo.
    void LeaveScene(const Path& path) {
        if (!Wanted()) return;
        const Rgb sky = Emission(scene, options.estimator, path, nullptr, {}, NoRecorder());
        Store({.albedo = ColorOf(sky * scene.film.scale, path)}, false);
    }

    void ReachSurface(const Path&, const Hit& found, const SurfaceInteraction&) {
        if (Wanted()) distance += found.t;
    }

    void MeetSurface(const Path& path, const Hit& found, const SurfaceInteraction& at,
                     const Bsdf& bsdf) {
        if (!Wanted()) return;
        const bool isSpecular =
            bsdf.LobeCount(LobeSet::All) > 0 && bsdf.LobeCount(LobeSet::NonSpecular) == 0 &&
            !(scene.materials.Needs(at.material) & kScattersBelow) && at.areaLight < 0;
        if (!IsDue(isSpecular)) return;
        Rgb color = AlbedoOf(bsdf, at.wo);
        Rgb emission = Rgb::Zero();
        if (at.areaLight >= 0) {
            const Rgb seen = Emission(scene, options.estimator, path, &at, found, NoRecorder());
            if (isDirect) emission = path.beta * seen;
            color = color.max(seen * scene.film.scale);
        }
        FirstHit hit = HitAt(color, at.p, path);
        hit.emission = emission;
        if (at.ns.allFinite()) hit.normal = at.n.dot(at.wo) < 0 ? Vec3f(-at.ns) : at.ns;
        hit.object = NumberOfObject(scene, found);
        hit.material = 1 + uint32_t(at.material);
        Store(hit, isSpecular);
    }

    // `path.beta` knows of the medium's albedo.
    void MeetMedium(const Path& path, float t, const Vec3f& p) {
        if (!Wanted()) return;
        distance += t;
        Store(HitAt(Rgb::Ones(), p, path), false);
    }

    void Scatter(const Path&, bool) { isDirect = false; }

  private:
    struct Recorded {
        FirstHit* hit;  // null: not wanted, or stored
        bool isThroughSpecular;

        bool IsDue(bool isSpecular) const { return hit && !(isSpecular && isThroughSpecular); }
    };

    // Returns whether a hit is recorded here, where the surface may be specular.
    bool IsDue(bool isSpecular) const {
        return hits[0].IsDue(isSpecular) || hits[1].IsDue(isSpecular);
    }

    void Store(FirstHit hit, bool isSpecular) {
        for (Recorded& recorded : hits) {
            if (!recorded.IsDue(isSpecular)) continue;
            hit.weight = recorded.hit->weight;
            hit.offset2 = recorded.hit->offset2;
            *std::exchange(recorded.hit, nullptr) = hit;
        }
    }

    FirstHit HitAt(const Rgb& color, const Vec3f& p, const Path& path) const {
        const float depth = Depth();
        return {.albedo = ColorOf(color, path),
                .position = p,
                .depth = depth,
                .found = p.allFinite() && std::isfinite(depth)};
    }

    // Refraction scales radiance by the indices' ratio; that is no matter of colour.
    static Rgb ColorOf(const Rgb& color, const Path& path) {
        const Rgb seen = path.beta * path.etaScale * color;
        return (seen > 0).select(seen.min(1.f), Rgb::Zero());
    }

    float Depth() const {
        const Camera& camera = scene.camera;
        if (camera.projection == Projection::Environment ||
            camera.projection == Projection::EqualArea)
            return distance;
        Vec3f axis = camera.rotation.col(2);
        if (camera.motion) axis = TransformVector(camera.motion->At(time), axis);
        const float scale = axis.norm();
        return distance * (direction.dot(axis) / scale) + camera.clipStart * scale;
    }

    const Scene& scene;
    const PathOptions& options;
    const Vec3f direction;
    const float time;
    GroupRadiance* groups;  // null: not wanted
    std::array<Recorded, 2> hits;
    float distance = 0;    // of the path so far, from where its first ray begins
    bool isDirect = true;  // nothing has scattered the path
};

// Records all of a path, in place of its first hit alone.

class PathRecorder : public NoRecorder {
  public:
    PathRecorder(const Scene& scene, std::vector<PathStep>* steps) : scene(scene), steps(steps) {}

    void LeaveScene(const Path& path) {
        Add(PathStep::Kind::Sky, path, 0, path.ray.d.normalized());
        Gain(path, &PathStep::emitted);
    }
    void ReachSurface(const Path& path, const Hit& found, const SurfaceInteraction& at) {
        PathStep& step = Add(PathStep::Kind::Surface, path, found.t, at.p);
        step.normal = at.n;
        step.object = NumberOfObject(scene, found);
        step.material = 1 + uint32_t(at.material);
        Gain(path, &PathStep::emitted);
    }
    void MeetMedium(const Path& path, float t, const Vec3f& p) {
        Add(PathStep::Kind::Medium, path, t, p);
        Gain(path, &PathStep::emitted);
    }
    void Scatter(const Path& path, bool isTransmission) {
        Gain(path, &PathStep::direct);
        PathStep& step = steps->back();
        step.goesOn = true;
        step.direction = path.ray.d.normalized();
        step.pdf = path.pdf;
        step.isSpecular = path.seesLights;
        step.isTransmission = isTransmission;
    }
    void End(const Path& path) {
        if (!steps->empty()) Gain(path, &PathStep::direct);
    }

  private:
    PathStep& Add(PathStep::Kind kind, const Path& path, float distance, const Vec3f& position) {
        PathStep& step = steps->emplace_back();
        step.kind = kind;
        step.distance = distance;
        step.position = position;
        step.throughput = path.beta;
        return step;
    }
    // Adds the radiance of the path since the last call.
    void Gain(const Path& path, Rgb PathStep::*part) {
        steps->back().*part += path.L - before;
        before = path.L;
    }

    const Scene& scene;
    std::vector<PathStep>* steps;
    Rgb before = Rgb::Zero();
};

}  // namespace lull
