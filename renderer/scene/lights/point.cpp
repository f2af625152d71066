#include "renderer/scene/lights/point.h"

#include "renderer/scene/lights/light_color.h"

namespace lull {

PointLight PointLight::Make(const LightReader& in) {
    const Parameters& params = in.entity.parameters;
    const Vec3f from = params.GetPoint3("from", Vec3f::Zero());
    const Rgb I = LightColor(in.entity, "I", in.warnings);
    return {TransformPoint(in.entity.worldFromLight, from), I};
}

std::optional<LightSample> PointLight::Sample(const Vec3f& from, const Vec2f&) const {
    const Vec3f d = p - from;
    const float distance2 = d.squaredNorm();
    const Rgb L = I / distance2;
    if (!(distance2 > 0) || !IsFinite(L)) return {};
    return LightSample{.L = L,
                       .wi = d / std::sqrt(distance2),
                       .pdf = 1,
                       .isDelta = true,
                       .isHidden = false,
                       .p = p};
}

std::optional<LightBounds> PointLight::Bounds() const {
    return LightBounds{.box = {p, p}, .cosNormals = -1, .power = BoundedPower(Power())};
}

}  // namespace lull
