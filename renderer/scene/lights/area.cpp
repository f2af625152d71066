#include "renderer/scene/lights/area.h"

namespace lull {

std::optional<LightBounds> AreaLight::Bounds() const {
    const NormalBounds normals = VisitEmitter(surface, [](const auto& e) { return e.Normals(); });
    return LightBounds{.box = VisitEmitter(surface, [](const auto& e) { return e.WorldBounds(); }),
                       .axis = normals.axis,
                       .cosNormals = normals.cosAngle,
                       .power = BoundedPower(Power()),
                       .isTwoSided = twoSided || normals.isTwoSided};
}

}  // namespace lull
