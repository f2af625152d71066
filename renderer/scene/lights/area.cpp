#include "renderer/scene/lights/area.h"

namespace lull {

std::optional<LightBounds> AreaLight::Bounds() const {
    if (const auto* cone = std::get_if<SpotCone>(profile)) {
        const Vec2f cosines = cone->CosinesOfBounds();
        return LightBounds{
            .box = VisitEmitter(surface, [](const auto& e) { return e.WorldBounds(); }),
            .axis = cone->axis,
            .cosNormals = cosines.x(),
            .cosEmission = cosines.y(),
            .power = BoundedPower(Whole())};
    }
    const auto* spread = std::get_if<Spread>(profile);
    const NormalBounds normals = VisitEmitter(surface, [](const auto& e) { return e.Normals(); });
    return LightBounds{.box = VisitEmitter(surface, [](const auto& e) { return e.WorldBounds(); }),
                       .axis = normals.axis,
                       .cosNormals = normals.cosAngle,
                       .cosEmission = spread ? spread->cosEmission : 0,
                       .power = BoundedPower(Power()),
                       .isTwoSided = twoSided || normals.isTwoSided};
}

}  // namespace lull
