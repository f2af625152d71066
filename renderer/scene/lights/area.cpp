#include "renderer/scene/lights/area.h"

namespace lull {

LightBounds AreaLight::Bounds() const {
    LightBounds bounds{.power = BoundedPower(Power()), .isTwoSided = twoSided};
    if (const auto* triangle = std::get_if<TriangleSampler>(&surface)) {
        for (const Vec3f& p : {triangle->p0, triangle->p1, triangle->p2}) bounds.box.Extend(p);
        bounds.axis = triangle->n;
    } else if (const auto* sphere = std::get_if<const Sphere*>(&surface)) {
        bounds.box = (*sphere)->WorldBounds();
        bounds.cosNormals = -1;
    } else if (const auto* disk = std::get_if<const Disk*>(&surface)) {
        bounds.box = (*disk)->WorldBounds();
        bounds.axis = SampledNormal(**disk);
        // Under a transform that mirrors, rays find light on the other side than samples.
        const QuadricPlacement& place = (*disk)->place;
        bounds.isTwoSided |= place.reverseOrientation != place.flipNormals;
    } else {
        bounds.box = std::get<const Revolved*>(surface)->WorldBounds();
        bounds.cosNormals = -1;
    }
    return bounds;
}

}  // namespace lull
