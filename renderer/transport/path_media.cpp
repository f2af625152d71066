#include "renderer/transport/path_media.h"

#include <algorithm>
#include <map>
#include <utility>

#include "renderer/base/math.h"
#include "renderer/bsdf/fresnel.h"

namespace lull {
namespace {

class Beam {
  public:
    Beam(const PathContext<Media>& context, RayKind kind, const Ray& ray, const MediumStack& media)
        : ray(ray), media(media), context(context), kind(kind) {}

    bool Advance() {
        const Scene& scene = context.scene;
        const bool isHit = scene.accelerator.Intersect(ray, &found, context.camera.time, kind);
        if (const int medium = media.Top(); medium != kVacuum) {
            Ray segment = ray;
            if (isHit) segment.tMax = found.t;
            transmittance *= scene.media.Transmittance(medium, segment, context.sampler);
        }
        if (!isHit) return false;
        const int material = scene.shapes.shapes[found.shape].material;
        const SurfaceNeeds needs = scene.materials.Needs(material);
        isInterface = needs & kIsInterface;
        if (needs & kLetsThrough)
            through = ShareThrough(scene, ray, found, context.camera.time, &hit);
        else
            scene.shapes.Interact(ray, found, kNeedsNothing, &hit, context.camera.time);
        isPane = (needs & kLetsThrough) && !IsBlack(through);
        media = Media::Beyond(scene, found.shape, hit, ray.d, true, media);
        return true;
    }
    bool GoThrough() {
        if (isPane) transmittance *= through;
        return (isInterface || isPane) && !IsBlack(transmittance);
    }

    Ray ray;
    Rgb transmittance = Rgb::Ones();
    // Of the surface where the beam is now:
    bool isInterface = false, isPane = false;
    Hit found;
    SurfaceInteraction hit;
    MediumStack media;  // beyond it

  private:
    const PathContext<Media>& context;
    const RayKind kind;
    Rgb through = Rgb::Zero();  // the pane
};

}  // namespace

namespace {

// Calls visit(medium, isLeft) for the surfaces of volumes on a ray to wi, until it returns false.
template <typename Visit>
void ForVolumesAhead(const Scene& scene, const SurfaceInteraction& hit, const Vec3f& wi,
                     const Visit& visit) {
    constexpr int kMostHits = 100;
    Ray ray = hit.SpawnRay(wi);
    Hit found;
    for (int i = 0; i < kMostHits && scene.accelerator.Intersect(ray, &found); ++i) {
        SurfaceInteraction at;
        scene.shapes.Interact(ray, found, kNeedsNothing, &at, 0);
        const MediumTable::Sides& sides = scene.media.ofShapes[size_t(found.shape)];
        if (sides.outside == ShapeEntity::kSurrounding && !visit(sides.inside, wi.dot(at.n) > 0))
            return;
        ray = at.SpawnRay(wi);
    }
}

}  // namespace

MediumStack Media::Beyond(const Scene& scene, int shape, const SurfaceInteraction& hit,
                          const Vec3f& wi, bool crosses, const MediumStack& current) {
    MediumStack beyond = scene.media.Beyond(shape, wi.dot(hit.n) > 0, crosses, current);
    if (!scene.media.hasVolumes) return beyond;
    if (beyond.Count() < current.Count()) {
        ForVolumesAhead(scene, hit, wi, [&](int medium, bool isLeft) {
            if (isLeft && beyond.CountOf(medium) == 0) beyond.Enter(medium);
            return false;
        });
        return beyond;
    }
    if (beyond.Count() < 2 || beyond.Count() == current.Count()) return beyond;
    // How often a medium is left more than it is entered, at some point ahead.
    std::map<int, std::pair<int, int>> left;  // by medium: so far, and the most
    ForVolumesAhead(scene, hit, wi, [&](int medium, bool isLeft) {
        auto& [soFar, most] = left[medium];
        most = std::max(most, soFar += isLeft ? 1 : -1);
        return true;
    });
    MediumStack kept;
    for (int i = 0; i + 1 < beyond.Count(); ++i)
        if (left[beyond.At(i)].second > beyond.CountOf(beyond.At(i), i + 1))
            kept.Enter(beyond.At(i));
    kept.Enter(beyond.Top());
    return kept;
}

Media::Visibility Media::Look(const Context& context, const Vec3f& origin, const Vec3f& target,
                              const MediumStack& from, bool isAtInfinity) {
    const auto rayFrom = [&](const Vec3f& o) { return Ray{o, target - o, 1 - 0.0001f}; };
    Beam beam(context, kShadowRay, rayFrom(origin), from);
    while (beam.Advance()) {
        if (!beam.GoThrough()) return {};
        beam.ray = rayFrom(beam.hit.SpawnRay(beam.ray.d).o);
    }
    Visibility visibility{.share = beam.transmittance};
    if (isAtInfinity) visibility.isOutOfReach = context.scene.media.Swallows(beam.media.Top());
    return visibility;
}

bool Media::Follow(const Context& context, const Ray& ray, const MediumStack& from, int index,
                   LightHit* lightHit) {
    Beam beam(context, kOtherRay, ray, from);
    while (beam.Advance()) {
        const bool isThere = context.scene.shapes.LightAt(beam.found) == index;
        if (isThere && !beam.isInterface) {
            lightHit->share = beam.transmittance;
            lightHit->found = beam.found;
            lightHit->at = beam.hit;
            return true;
        }
        if (!beam.GoThrough()) return false;
        beam.ray = beam.hit.SpawnRay(ray.d);
    }
    lightHit->share = beam.transmittance;
    return index == kNothing;
}

namespace {

bool IsShadowless(const Scene& scene, const Shape& shape, const Hit& found, const Vec3f& p) {
    if (!shape.shadowAlpha) return false;
    const Vec2f uv = scene.shapes.Uv(found.shape, found.primitive, found.b1, found.b2);
    return scene.textures.Evaluate(*shape.shadowAlpha, TextureContext{p, uv}) == 0;
}

}  // namespace

Rgb ShareThrough(const Scene& scene, const Ray& ray, const Hit& found, float time,
                 SurfaceInteraction* hit) {
    const SurfaceNeeds needs = scene.materials.Needs(scene.shapes.shapes[found.shape].material);
    scene.shapes.Interact(ray, found, needs, hit, time);
    if (!(needs & kLetsThrough)) return Rgb::Zero();
    hit->wo = -ray.d.normalized();
    return scene.materials.MakeBsdf(scene.textures, hit).StraightThrough(hit->wo);
}

Rgb ShareThroughPanes(const Scene& scene, const Ray& whole, float time) {
    const bool hasEnd = whole.tMax < kInfinity;
    const Vec3f end = hasEnd ? Vec3f(whole.o + whole.tMax * whole.d) : Vec3f(Vec3f::Zero());
    Rgb share = Rgb::Ones();
    Ray ray = whole;
    Hit found;
    while (scene.accelerator.Intersect(ray, &found, time, kShadowRay)) {
        const Shape& shape = scene.shapes.shapes[found.shape];
        if (!(scene.materials.Needs(shape.material) & kLetsThrough) && !shape.shadowAlpha)
            return Rgb::Zero();
        SurfaceInteraction hit;
        const Rgb through = ShareThrough(scene, ray, found, time, &hit);
        if (!IsShadowless(scene, shape, found, hit.p)) share *= through;
        if (IsBlack(share)) return share;
        ray = hit.SpawnRay(whole.d);
        if (!hasEnd) continue;
        ray.d = end - ray.o;
        ray.tMax = 1;
        if (!(ray.d.dot(whole.d) > 0)) break;  // the pane touches the end
    }
    return share;
}

bool GoesThroughPane(const Vec3f& wo, bool mustGo, Sampler& sampler, Bsdf* bsdf, Rgb* beta) {
    const Rgb through = bsdf->StraightThrough(wo);
    if (!(through.sum() > 0)) return false;
    float share = 1;
    if (!mustGo) {
        bsdf->BlockStraight();
        const Vec3f local = bsdf->FrameTowards(wo).ToLocal(wo);
        float scattered = 0;
        for (int i = 0; i < bsdf->LobeCount(LobeSet::All); ++i)
            scattered += EstimatedAlbedo(bsdf->At(i), local);
        const float luminance = Luminance(through);
        if (scattered > 0) share = std::clamp(luminance / (luminance + scattered), 0.05f, 0.95f);
        if (share < 1 && !(sampler.Get1D() < share)) {
            *beta /= 1 - share;
            return false;
        }
    }
    *beta *= through / share;
    return true;
}

namespace {

// Chosen half of the time is the probe along the normal, which finds most.
constexpr std::array<float, 3> kAxisShares = {0.25f, 0.25f, 0.5f};

// Returns the density by area of finding p, of normal n, by probes of all axes and channels.
float ProbePdf(const SubsurfaceProfile& profile, const Frame& frame, const Vec3f& d,
               const Vec3f& n) {
    const Vec3f local = frame.ToLocal(d), normal = frame.ToLocal(n);
    float pdf = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const float r = std::hypot(local[(axis + 1) % 3], local[(axis + 2) % 3]);
        for (int c = 0; c < 3; ++c)
            pdf += profile.Pdf(c, r) * std::abs(normal[axis]) * kAxisShares[axis] / 3;
    }
    return pdf;
}

// Represents the segment of a probe ray, and how its hits are chosen among.
struct Probe {
    Vec3f from, to;
    float u;  // the rest of the number that chose axis and channel
};

std::optional<Probe> ChooseProbe(const SubsurfaceProfile& profile, const Frame& frame,
                                 const Vec3f& p, float u, const Vec2f& v, float reach) {
    const Vec3f* axes[3];  // the probe is along the last one
    if (u < 0.5f) {
        axes[0] = &frame.s, axes[1] = &frame.t, axes[2] = &frame.n;
        u *= 2;
    } else if (u < 0.75f) {
        axes[0] = &frame.t, axes[1] = &frame.n, axes[2] = &frame.s;
        u = (u - 0.5f) * 4;
    } else {
        axes[0] = &frame.n, axes[1] = &frame.s, axes[2] = &frame.t;
        u = (u - 0.75f) * 4;
    }
    const int channel = std::min(int(3 * u), 2);
    const auto r = profile.Sample(channel, v.x());
    // Light further away than that is left out, as in pbrt-v3; and where no ray is traced.
    const auto most = profile.Sample(channel, 0.999f);
    if (!r || !most || !(*r < *most)) return {};
    if (!(*most <= reach)) return {};
    const float phi = 2 * kPi * v.y(), half = std::sqrt(Sqr(*most) - Sqr(*r));
    const Vec3f middle = p + *r * (std::cos(phi) * *axes[0] + std::sin(phi) * *axes[1]);
    return Probe{middle - half * *axes[2], middle + half * *axes[2], 3 * u - float(channel)};
}

}  // namespace

std::optional<SubsurfaceExit> SampleSubsurface(const Scene& scene, Sampler& sampler,
                                               const SurfaceInteraction& hit, const Bsdf& bsdf,
                                               const SubsurfaceProfile& profile, float time) {
    const float u = sampler.Get1D();
    const auto probe =
        ChooseProbe(profile, bsdf.Shading(), hit.p, u, sampler.Get2D(), scene.shapes.reach);
    if (!probe) return {};

    // Choose one of all hits of this material with equal probability: each new one replaces the one
    // before with probability 1 / count, by the rest of the same number.
    std::optional<SubsurfaceExit> exit;
    int count = 0;
    float rest = probe->u;
    Ray ray{probe->from, probe->to - probe->from, 1 - 0.0001f};
    Hit found;
    while (!ray.d.isZero(0) && scene.accelerator.Intersect(ray, &found, time)) {
        SurfaceInteraction at;
        scene.shapes.Interact(ray, found, kNeedsNothing, &at, time);
        ray.d = probe->to - at.p;
        ray.o = OffsetRayOrigin(at.p, at.pError, at.n, ray.d);
        if (at.material != hit.material) continue;
        const float share = 1 / float(++count);
        const bool isTaken = rest < share;
        rest = isTaken ? rest * float(count) : (rest - share) / (1 - share);
        if (isTaken) exit = SubsurfaceExit{at, found.shape, Rgb(0, 0, 0)};
    }
    if (!exit) return {};
    const Vec3f d = exit->hit.p - hit.p;
    const float pdf = ProbePdf(profile, bsdf.Shading(), d, exit->hit.n) / float(count);
    exit->weight = profile(d.norm()) / pdf;
    if (!(pdf > 0) || IsBlack(exit->weight) || !IsFinite(exit->weight)) return {};
    exit->hit.wo = exit->hit.ns;
    return exit;
}

Bsdf ExitBsdf(const SubsurfaceExit& exit, float eta) {
    Frame frame{{}, {}, exit.hit.ns};
    CoordinateSystem(frame.n, &frame.s, &frame.t);
    Bsdf bsdf(frame, exit.hit.n, eta);
    // eta^2 undoes the scaling of radiance by refraction into the solid.
    const float norm = float(1 - 2 * FresnelMoment1(1 / double(eta)));
    bsdf.Add(DiffuseExit{Rgb(Rgb::Constant(Sqr(eta) / norm)), eta});
    return bsdf;
}

}  // namespace lull
