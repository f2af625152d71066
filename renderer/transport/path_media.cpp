#include "renderer/transport/path_media.h"

namespace lull {
namespace {

// Follows a ray through interfaces and panes, and multiplies the transmittances of their media.
class Beam {
  public:
    Beam(const PathContext<Media>& context, RayKind kind, const Ray& ray, int medium)
        : ray(ray), medium(medium), context(context), kind(kind) {}

    // Goes on to the next surface, or to the end of the ray. Returns whether a surface is there.
    bool Advance() {
        const Scene& scene = context.scene;
        const bool isHit = scene.accelerator.Intersect(ray, &found, context.camera.time, kind);
        if (medium != kVacuum) {
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
        medium = scene.media.Beyond(found.shape, ray.d.dot(hit.n) > 0, medium);
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
    int medium;  // beyond it

  private:
    const PathContext<Media>& context;
    const RayKind kind;
    Rgb through = Rgb::Zero();  // the pane
};

}  // namespace

Media::Visibility Media::Look(const Context& context, const Vec3f& origin, const Vec3f& target,
                              int from, bool isAtInfinity) {
    const auto rayFrom = [&](const Vec3f& o) { return Ray{o, target - o, 1 - 0.0001f}; };
    Beam beam(context, kShadowRay, rayFrom(origin), from);
    while (beam.Advance()) {
        if (!beam.GoThrough()) return {};
        beam.ray = rayFrom(beam.hit.SpawnRay(beam.ray.d).o);
    }
    Visibility visibility{.share = beam.transmittance};
    if (isAtInfinity) visibility.isOutOfReach = context.scene.media.Swallows(beam.medium);
    return visibility;
}

bool Media::Follow(const Context& context, const Ray& ray, int from, int index,
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

}  // namespace lull
