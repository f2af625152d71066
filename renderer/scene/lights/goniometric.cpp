#include "renderer/scene/lights/goniometric.h"

#include "renderer/scene/lights/light_color.h"

namespace lull {

GoniometricLight GoniometricLight::Make(const LightReader& in) {
    const Rgb I = LightColor(in.entity, "I", in.warnings);
    return {TransformPoint(in.entity.worldFromLight, Vec3f::Zero()), I,
            in.entity.worldFromLight.inverse().topLeftCorner<3, 3>().cast<float>(),
            ReadLightImage(in)};
}

std::optional<LightSample> GoniometricLight::Sample(const Vec3f& from, const Vec2f&) const {
    const Vec3f d = p - from;
    const float distance2 = d.squaredNorm();
    if (!(distance2 > 0)) return {};
    const Vec3f wi = d / std::sqrt(distance2);
    Rgb L = I / distance2;
    if (image) {
        const Vec3f w = (lightFromWorld * -wi).normalized();
        const float phi = std::atan2(w.z(), w.x());
        L *= image->Lookup({(phi < 0 ? phi + 2 * kPi : phi) / (2 * kPi),
                            std::acos(std::clamp(w.y(), -1.f, 1.f)) * kInvPi});
    }
    if (!IsFinite(L)) return {};
    return LightSample{.L = L, .wi = wi, .pdf = 1, .isDelta = true, .isHidden = false, .p = p};
}

std::optional<LightBounds> GoniometricLight::Bounds() const {
    return LightBounds{.box = {p, p}, .cosNormals = -1, .power = BoundedPower(Power())};
}

}  // namespace lull
