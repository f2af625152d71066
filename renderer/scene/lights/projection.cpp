#include "renderer/scene/lights/projection.h"

#include <fmt/format.h>

#include "renderer/scene/lights/light_color.h"

namespace lull {

ProjectionLight ProjectionLight::Make(const LightReader& in) {
    const Parameters& params = in.entity.parameters;
    ProjectionLight light;
    light.p = TransformPoint(in.entity.worldFromLight, Vec3f::Zero());
    light.I = LightColor(in.entity, "I", in.warnings);
    light.lightFromWorld = in.entity.worldFromLight.inverse().topLeftCorner<3, 3>().cast<float>();
    const float fov = params.GetFloat("fov", 45);
    if (!(fov > 0 && fov < 180))
        throw Error(in.entity.loc,
                    fmt::format("the projection light's \"fov\" is {} degrees; it has "
                                "to lie between 0 and 180",
                                fov));
    light.perTangent = 1 / std::tan(fov * kPi / 360);
    light.image = ReadLightImage(in);
    const float aspect =
        light.image ? float(light.image->image.width) / float(light.image->image.height) : 1;
    light.screen = aspect > 1 ? Vec2f(aspect, 1) : Vec2f(1, 1 / aspect);
    return light;
}

std::optional<LightSample> ProjectionLight::Sample(const Vec3f& from, const Vec2f&) const {
    const Vec3f d = p - from;
    const float distance2 = d.squaredNorm();
    if (!(distance2 > 0)) return {};
    const Vec3f wi = d / std::sqrt(distance2);
    const Vec3f w = lightFromWorld * -wi;
    constexpr float kHither = 1e-3f;  // pbrt-v3's near plane
    if (!(w.z() >= kHither)) return {};
    const Vec2f q = w.head<2>() * (perTangent / w.z());
    if (!(q.cwiseAbs().array() <= screen.array()).all()) return {};
    Rgb L = I / distance2;
    if (image) L *= image->Lookup((q + screen).cwiseQuotient(2 * screen));
    if (!IsFinite(L)) return {};
    return LightSample{.L = L, .wi = wi, .pdf = 1, .isDelta = true, .isHidden = false, .p = p};
}

Rgb ProjectionLight::Power() const {
    // The cone to the corner of the image, as if that were filled (pbrt-v3).
    const float cosCorner = 1 / std::sqrt(1 + (screen / perTangent).squaredNorm());
    const Rgb mean = image ? image->mean : Rgb(Rgb::Ones());
    return 2 * kPi * (1 - cosCorner) * I * mean;
}

std::optional<LightBounds> ProjectionLight::Bounds() const {
    return LightBounds{.box = {p, p}, .cosNormals = -1, .power = BoundedPower(Power())};
}

}  // namespace lull
