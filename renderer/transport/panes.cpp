#include "renderer/transport/panes.h"

#include "renderer/base/color.h"

namespace lull {
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
