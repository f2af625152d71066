#include "renderer/scene/lights/area.h"

namespace lull {

std::optional<LightBounds> AreaLight::Bounds() const {
    if (cone) {
        const Vec2f cosines = cone->CosinesOfBounds();
        return LightBounds{
            .box = VisitEmitter(surface, [](const auto& e) { return e.WorldBounds(); }),
            .axis = cone->axis,
            .cosNormals = cosines.x(),
            .cosEmission = cosines.y(),
            .power = BoundedPower(Whole())};
    }
    const NormalBounds normals = VisitEmitter(surface, [](const auto& e) { return e.Normals(); });
    return LightBounds{.box = VisitEmitter(surface, [](const auto& e) { return e.WorldBounds(); }),
                       .axis = normals.axis,
                       .cosNormals = normals.cosAngle,
                       .power = BoundedPower(Power()),
                       .isTwoSided = twoSided || normals.isTwoSided};
}

}  // namespace lull
