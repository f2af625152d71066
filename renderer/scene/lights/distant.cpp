#include "renderer/scene/lights/distant.h"

#include "renderer/scene/lights/light_color.h"

namespace lull {

DistantLight DistantLight::Make(const LightReader& in) {
    const LightEntity& entity = in.entity;
    const Parameters& params = entity.parameters;
    const Rgb L = LightColor(entity, "L", in.warnings);
    const Vec3f from = params.GetPoint3("from", Vec3f::Zero());
    const Vec3f to = params.GetPoint3("to", Vec3f(0, 0, 1));
    const Vec3f w = TransformVector(entity.worldFromLight, from - to);
    if (!(w.norm() > 0))
        throw Error(entity.loc, "the distant light's \"from\" and \"to\" coincide");
    return {w.normalized(), L, in.worldRadius};
}

std::optional<LightSample> DistantLight::Sample(const Vec3f&, const Vec2f&) const {
    return LightSample{
        .L = L, .wi = w, .pdf = 1, .isDelta = true, .isHidden = false, .isAtInfinity = true};
}

}  // namespace lull
