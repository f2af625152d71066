#include "renderer/transport/path_media.h"

namespace lull {
namespace {

// Follows a ray through interfaces and multiplies the transmittances of their media.
class Beam {
  public:
    Beam(const PathContext<Media>& context, const Ray& ray, int medium)
        : ray(ray), medium(medium), context(context) {}

    // Goes on to the next surface, or to the end of the ray. Returns whether a surface is there.
    bool Advance() {
        const Scene& scene = context.scene;
        const bool isHit = scene.accelerator.Intersect(ray, &found, context.camera.time);
        if (medium != kVacuum) {
            Ray segment = ray;
            if (isHit) segment.tMax = found.t;
            transmittance *= scene.media.Transmittance(medium, segment, context.sampler);
        }
        if (!isHit) return false;
        const int material = scene.shapes.shapes[found.shape].material;
        isInterface = scene.materials.Needs(material) & kIsInterface;
        scene.shapes.Interact(ray, found, kNeedsNothing, &hit, context.camera.time);
        medium = scene.media.Beyond(found.shape, ray.d.dot(hit.n) > 0, medium);
        return true;
    }

    Ray ray;
    Rgb transmittance = Rgb::Ones();
    // Of the surface where the beam is now:
    bool isInterface = false;
    Hit found;
    SurfaceInteraction hit;
    int medium;  // beyond it

  private:
    const PathContext<Media>& context;
};

}  // namespace

Media::Sight Media::Look(const Context& context, const Vec3f& origin, const Vec3f& target, int from,
                         bool isAtInfinity) {
    const auto rayFrom = [&](const Vec3f& o) { return Ray{o, target - o, 1 - 0.0001f}; };
    Beam beam(context, rayFrom(origin), from);
    while (beam.Advance()) {
        if (!beam.isInterface || IsBlack(beam.transmittance)) return {};
        beam.ray = rayFrom(beam.hit.SpawnRay(beam.ray.d).o);
    }
    Sight sight{.share = beam.transmittance};
    if (isAtInfinity) sight.isOutOfReach = context.scene.media.Swallows(beam.medium);
    return sight;
}

int Media::Follow(const Context& context, const Ray& ray, int from, Sighting* sighting) {
    Beam beam(context, ray, from);
    bool isHit;
    while ((isHit = beam.Advance()) && beam.isInterface) {
        if (IsBlack(beam.transmittance)) return kNoLight;
        beam.ray = beam.hit.SpawnRay(ray.d);
    }
    sighting->share = beam.transmittance;
    if (!isHit) return kNothing;
    sighting->found = beam.found;
    sighting->at = beam.hit;
    const int light = context.scene.shapes.LightAt(beam.found);
    return light >= 0 ? light : kNoLight;
}

}  // namespace lull
