#include "renderer/scene/lights/light_emission.h"

namespace lull {
namespace {

constexpr float kUniformSphere = 1 / (4 * kPi);

struct Cone {
    Vec3f axis = Vec3f::UnitZ();
    float cosAngle = -1;

    float Density() const { return 1 / (2 * kPi * (1 - cosAngle)); }
    bool Has(const Vec3f& w) const { return w.dot(axis) >= cosAngle; }
    Vec3f Sample(const Vec2f& u) const {
        const float cosine = Lerp(u.x(), cosAngle, 1.f), sine = SafeSqrt(1 - Sqr(cosine));
        const float phi = 2 * kPi * u.y();
        Vec3f s, t;
        CoordinateSystem(axis, &s, &t);
        return (sine * std::cos(phi) * s + sine * std::sin(phi) * t + cosine * axis).normalized();
    }
};

// Return the cones that lights of one place shine into.
Cone ConeOf(const PointLight&) { return {}; }
Cone ConeOf(const GoniometricLight&) { return {}; }
Cone ConeOf(const SpotCone& cone) {
    return {cone.axis, std::clamp(cone.cosTotalWidth, -1.f, 1 - 1e-6f)};
}
Cone ConeOf(const SpotLight& light) { return ConeOf(light.cone); }
// A transform that stretches the picture could make the cone wider: then all directions do.
Cone ConeOf(const ProjectionLight& light) {
    const Mat3f& m = light.lightFromWorld;
    if (!ScalesEvenly(m)) return {};
    const float tangent = light.screen.norm() / light.perTangent;
    return {Vec3f(m.transpose().col(2)).normalized(),
            std::min(1 / std::sqrt(1 + Sqr(1.001f * tangent)), 1 - 1e-6f)};
}

// Returns the luminance of a light's power, for its choice; 0 if float cannot hold it. Of the sky
// it is that from one steradian, as in pbrt-v3: paths from the camera find it anyway.
float Weight(const Light& light) {
    const float power = Luminance(std::visit([](const auto& l) { return l.Power(); }, light));
    return power > 0 && std::isfinite(power) ? power : 0;
}

// Returns the density of direction w from a point with normal n.
float OnwardDensity(const AreaLight& light, const Vec3f& n, const Vec3f& w) {
    if (const auto* spot = std::get_if<SpotCone>(light.profile)) {
        const Cone cone = ConeOf(*spot);
        return cone.Has(w) && (light.twoSided || n.dot(w) > 0) ? cone.Density() : 0;
    }
    const float cosine = n.dot(w) * kInvPi;
    const float density = light.twoSided ? 0.5f * std::abs(cosine) : std::max(0.f, cosine);
    const auto* spread = std::get_if<Spread>(light.profile);
    if (!spread) return density;
    return spread->Has(n, w) ? density / Sqr(spread->sine) : 0;
}

Vec3f SampleAboutNormal(const Vec3f& n, bool twoSided, float sine, Vec2f u) {
    float side = 1;
    if (twoSided) {
        side = u.x() < 0.5f ? 1.f : -1.f;
        u.x() = std::min(u.x() < 0.5f ? 2 * u.x() : 2 * u.x() - 1, kOneMinusEpsilon);
    }
    Frame frame{{}, {}, side * n};
    CoordinateSystem(frame.n, &frame.s, &frame.t);
    return frame.FromLocal(SampleCosineHemisphere(u, sine)).normalized();
}

Vec3f SampleOnward(const AreaLight& light, const Vec3f& n, const Vec2f& u) {
    if (const auto* spot = std::get_if<SpotCone>(light.profile)) return ConeOf(*spot).Sample(u);
    const auto* spread = std::get_if<Spread>(light.profile);
    return SampleAboutNormal(n, light.twoSided, spread ? spread->sine : 1, u);
}

}  // namespace

LightEmission::LightEmission(const LightTable& lights, const Bounds3f& bounds) : lights(lights) {
    if (!bounds.IsEmpty()) {
        center = 0.5f * (bounds.lower + bounds.upper);
        // Farther out than the scene's own corners, by more than rounding.
        radius = std::max(1.001f * (bounds.upper - center).norm(), 1e-10f);
    }
    std::vector<float> weights;
    for (int i = 0; i < lights.Count(); ++i) weights.push_back(Weight(lights[i]));
    choice = Distribution1D(weights);
    anyPower = choice.Integral() > 0;
}

std::optional<EmittedRay> LightEmission::Sample(float u, const Vec2f& origin,
                                                const Vec2f& direction) const {
    if (!anyPower) return {};
    EmittedRay ray;
    float pmf;
    ray.light = choice.SampleDiscrete(u, &pmf);
    const Light& light = lights[ray.light];
    const bool isSampled = Visit(light, [&]<typename L>(const L& l) {
        if constexpr (L::kType == LightType::Area) {
            const ShapeSample s =
                VisitEmitter(l.surface, [&](const auto& e) { return SampleArea(e, origin); });
            ray.p = s.p, ray.pError = s.pError, ray.n = s.n;
            ray.w = SampleOnward(l, s.n, direction);
            ray.L = l.Le(s.n, ray.w);
            if (l.map) ray.L *= l.map->Sampled(l.triangle, origin);
        } else if constexpr (L::kType == LightType::DeltaPosition) {
            ray.p = l.p;
            ray.w = ConeOf(l).Sample(direction);
            // At a distance of the scene's size, rounding does not turn the direction.
            const auto lit = l.Sample(l.p + radius * ray.w, Vec2f::Zero());
            if (!lit) return false;
            ray.L = lit->L * Sqr(radius);
        } else {
            const auto lit = l.Sample(center, direction);
            if (!lit) return false;
            ray.w = -lit->wi;
            ray.L = lights.Radiance(ray.light, *lit);
            ray.isAtInfinity = true;
            const Vec2f d = radius * SampleConcentricDisk(origin);
            Vec3f s, t;
            CoordinateSystem(ray.w, &s, &t);
            ray.p = center - radius * ray.w + d.x() * s + d.y() * t;
        }
        return true;
    });
    if (!isSampled || IsBlack(ray.L) || !IsFinite(ray.L)) return {};
    ray.density = Density(ray.light, ray.n, ray.w);
    if (!(ray.density.origin > 0 && ray.density.onward > 0)) return {};
    return ray;
}

EmissionDensity LightEmission::Density(int index, const Vec3f& n, const Vec3f& w) const {
    const float pmf = Pmf(index);
    if (!(pmf > 0)) return {};
    return Visit(lights[index], [&]<typename L>(const L& l) -> EmissionDensity {
        if constexpr (L::kType == LightType::Area) {
            return {pmf / l.Area(), OnwardDensity(l, n, w)};
        } else if constexpr (L::kType == LightType::DeltaPosition) {
            const Cone cone = ConeOf(l);
            if (cone.cosAngle == -1) return {pmf, kUniformSphere};
            return {pmf, cone.Has(w) ? cone.Density() : 0};
        } else {
            const float across = 1 / (kPi * Sqr(radius));
            if constexpr (L::kType == LightType::Infinite)
                return {pmf * l.LeAndPdf(Vec3f::Zero(), -w).pdf, across};
            else
                return {pmf, across};
        }
    });
}

}  // namespace lull
