#include "renderer/transport/path_media.h"

#include <map>

#include "renderer/base/color.h"

namespace lull {
namespace {

// Follows a ray through interfaces and panes, and multiplies the transmittances of their media.
class Beam {
  public:
    Beam(const PathContext<Media>& context, RayKind kind, const Ray& ray, const MediumStack& media)
        : ray(ray), media(media), context(context), kind(kind) {}

    // Goes on to the next surface, or to the end of the ray. Returns whether a surface is there.
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
    // Goes through the surface. Returns false where no light does.
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

MediumStack Media::Beyond(const Scene& scene, int shape, const SurfaceInteraction& hit,
                          const Vec3f& wi, bool crosses, const MediumStack& current) {
    const MediumStack beyond = scene.media.Beyond(shape, wi.dot(hit.n) > 0, crosses, current);
    if (beyond.Count() < 2 || beyond.Count() <= current.Count()) return beyond;
    constexpr int kMostHits = 100;
    std::map<int, bool> isLeft;  // before it is entered, by medium
    Ray ray = hit.SpawnRay(wi);
    Hit found;
    for (int i = 0; i < kMostHits && scene.accelerator.Intersect(ray, &found); ++i) {
        SurfaceInteraction at;
        scene.shapes.Interact(ray, found, kNeedsNothing, &at, 0);
        const MediumTable::Sides& sides = scene.media.ofShapes[size_t(found.shape)];
        if (sides.outside == ShapeEntity::kSurrounding)
            isLeft.try_emplace(sides.inside, wi.dot(at.n) > 0);
        ray = at.SpawnRay(wi);
    }
    MediumStack kept;
    for (int i = 0; i + 1 < beyond.Count(); ++i)
        if (const auto it = isLeft.find(beyond.At(i)); it != isLeft.end() && it->second)
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

}  // namespace lull
