#include "renderer/scene/lights/spot.h"

#include "renderer/scene/lights/light_color.h"

namespace lull {

SpotLight SpotLight::Make(const LightReader& in) {
    const Parameters& params = in.entity.parameters;
    const Rgb I = LightColor(in.entity, "I", in.warnings);
    const float cone = params.GetFloat("coneangle", 30);
    const float delta = params.GetFloat("conedeltaangle", 5);
    const Vec3f from = params.GetPoint3("from", Vec3f::Zero());
    const Vec3f to = params.GetPoint3("to", Vec3f(0, 0, 1));
    const Vec3f axis = TransformVector(in.entity.worldFromLight, (to - from).normalized());
    if (!(axis.norm() > 0))
        throw Error(in.entity.loc, "the spot light's \"from\" and \"to\" coincide");
    return {TransformPoint(in.entity.worldFromLight, from),
            axis.normalized(),
            I,
            std::cos(cone * kPi / 180),
            std::cos((cone - delta) * kPi / 180),
            in.entity.name == "spot-squared"};
}

std::optional<LightSample> SpotLight::Sample(const Vec3f& from, const Vec2f&) const {
    const Vec3f d = p - from;
    const float distance2 = d.squaredNorm();
    if (!(distance2 > 0)) return {};
    const Vec3f wi = d / std::sqrt(distance2);
    const float cosTheta = -wi.dot(axis);
    if (cosTheta < cosTotalWidth) return {};
    const float x = cosTheta >= cosFalloffStart
                        ? 1.f
                        : (cosTheta - cosTotalWidth) / (cosFalloffStart - cosTotalWidth);
    const Rgb L = I * ((isSquared ? Sqr(x) : Sqr(Sqr(x))) / distance2);
    if (!IsFinite(L)) return {};
    return LightSample{.L = L, .wi = wi, .pdf = 1, .isDelta = true, .isHidden = false, .p = p};
}

// Within the cone the light is taken as bright as a point light of this intensity; it leaves along
// "normals" up to where it begins to fall off.
std::optional<LightBounds> SpotLight::Bounds() const {
    const float start = std::acos(std::clamp(cosFalloffStart, -1.f, 1.f));
    const float total = std::acos(std::clamp(cosTotalWidth, -1.f, 1.f));
    return LightBounds{.box = {p, p},
                       .axis = axis,
                       .cosNormals = std::cos(std::clamp(start, 0.f, total)),
                       .cosEmission = std::cos(std::clamp(total - start, 0.f, total) + 1e-3f),
                       .power = BoundedPower(4 * kPi * I)};
}

}  // namespace lull
