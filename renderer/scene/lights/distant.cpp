#include "renderer/scene/lights/distant.h"

#include <numbers>

#include "renderer/base/sampling.h"
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

// The disc's irradiance is pi sin^2 of its radius times L.
SunLight::SunLight(const DistantLight& parallel, double angle)
    : w(parallel.w),
      L(parallel.L / float(std::numbers::pi * Sqr(std::sin(angle / 2)))),
      height(float(2 * Sqr(std::sin(angle / 4)))),
      solidAngle(2 * kPi * height),
      power(parallel.Power()) {}

std::optional<LightSample> SunLight::Sample(const Vec3f&, const Vec2f& u) const {
    // A point of the unit disk, whose area is that of the cap.
    const Vec2f d = SampleConcentricDisk(u);
    const float h = height * std::min(d.squaredNorm(), 1.f);
    const float across = std::sqrt(height * (2 - h));
    Vec3f s, t;
    CoordinateSystem(w, &s, &t);
    return LightSample{.L = L,
                       .wi = ((1 - h) * w + across * (d.x() * s + d.y() * t)).normalized(),
                       .pdf = 1 / solidAngle,
                       .isDelta = false,
                       .isHidden = false,
                       .isAtInfinity = true};
}

}  // namespace lull
