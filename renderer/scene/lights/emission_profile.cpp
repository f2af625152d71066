#include "renderer/scene/lights/emission_profile.h"

#include <numbers>

namespace lull {

SpotCone SpotCone::Make(const Entity& entity, const Mat4d& worldFromLight, bool isSquared) {
    const Parameters& params = entity.parameters;
    const float cone = params.GetFloat("coneangle", 30);
    const float delta = params.GetFloat("conedeltaangle", 5);
    const Vec3f from = params.GetPoint3("from", Vec3f::Zero());
    const Vec3f to = params.GetPoint3("to", Vec3f(0, 0, 1));
    const Vec3f axis = TransformVector(worldFromLight, (to - from).normalized());
    if (!(axis.norm() > 0))
        throw Error(entity.loc, "the spot light's \"from\" and \"to\" coincide");
    return {axis.normalized(), std::cos(cone * kPi / 180), std::cos((cone - delta) * kPi / 180),
            isSquared};
}

Vec2f SpotCone::CosinesOfBounds() const {
    const float start = std::acos(std::clamp(cosFalloffStart, -1.f, 1.f));
    const float total = std::acos(std::clamp(cosTotalWidth, -1.f, 1.f));
    return {std::cos(std::clamp(start, 0.f, total)),
            std::cos(std::clamp(total - start, 0.f, total) + 1e-3f)};
}

Spread Spread::Make(double degrees) {
    constexpr double kLeast = 1e-3;  // below, directions of float are too coarse
    const double h = std::max(degrees * std::numbers::pi / 360, kLeast), tangent = std::tan(h);
    return {float(tangent), float(std::sin(h)), float(std::cos(std::min(h + 1e-3, 1.5707963))),
            float(1 / (tangent - h))};
}

float PowerFraction(const EmissionProfile& profile) {
    const auto* cone = std::get_if<SpotCone>(&profile);
    return cone ? cone->SolidAngle() / (4 * kPi) : 1;
}

}  // namespace lull
