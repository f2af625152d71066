// How the light of spots and of area lights depends on the direction.
#pragma once

#include <variant>

#include "renderer/base/visit.h"
#include "renderer/input/description.h"

namespace lull {

// How the light of spots falls off to the sides.
//
// The light is whole up to the angle whose cosine is cosFalloffStart, and falls smoothly to none at
// that of cosTotalWidth: by the fourth power of how far the cosine is from there, as in pbrt-v3, or
// by its square, as KHR_lights_punctual proposes.
struct SpotCone {
    Vec3f axis;  // unit, world
    float cosTotalWidth, cosFalloffStart;
    bool isSquared = false;

    // Reads "from", "to", "coneangle" and "conedeltaangle", degrees. Throws Error where the points
    // are the same.
    static SpotCone Make(const Entity&, const Mat4d& worldFromLight, bool isSquared);

    // Returns the fraction of the light that leaves towards w, unit.
    float Falloff(const Vec3f& w) const {
        const float cosTheta = w.dot(axis);
        if (cosTheta < cosTotalWidth) return 0;
        const float x = cosTheta >= cosFalloffStart
                            ? 1.f
                            : (cosTheta - cosTotalWidth) / (cosFalloffStart - cosTotalWidth);
        return isSquared ? Sqr(x) : Sqr(Sqr(x));
    }
    // Returns about how many steradians the whole light would fill, as pbrt-v3 has it.
    float SolidAngle() const { return 2 * kPi * (1 - 0.5f * (cosFalloffStart + cosTotalWidth)); }
    // Returns the cosines of the angle where the light begins to fall off, and of that from there
    // to where it ends: LightBounds.
    Vec2f CosinesOfBounds() const;
};

// The light of each point leaves within a cone about its normal: the radiance falls with the
// tangent of the angle, to none at the edge, as with the spread of Cycles' area lamps. The power is
// that of the same radiance to all sides, as the integral over the cone of (tan h - tan theta) cos
// theta is pi (tan h - h).
struct Spread {
    float tangent, sine;  // of h, half the angle across the cone
    float cosEmission;    // as in LightBounds
    float scale;          // 1 / (tan h - h)

    // `degrees`, across the cone: above 0, at most 180; below 0.12, as 0.12.
    static Spread Make(double degrees);

    // Returns whether the cone about n, unit, has w, unit, on either side.
    bool Has(const Vec3f& n, const Vec3f& w) const { return n.cross(w).norm() < sine; }
};

using EmissionProfile = std::variant<SpotCone, Spread>;

// Return the factor of the radiance that leaves a point with normal n towards w, both unit. The
// normal's side is for callers to check.
inline float Falloff(const SpotCone& cone, const Vec3f&, const Vec3f& w) { return cone.Falloff(w); }
inline float Falloff(const Spread& spread, const Vec3f& n, const Vec3f& w) {
    // The cross product keeps small angles, which the cosine rounds away.
    const float tangent = n.cross(w).norm() / std::abs(n.dot(w));
    return spread.scale * std::max(0.f, spread.tangent - tangent);
}
inline float Falloff(const EmissionProfile& profile, const Vec3f& n, const Vec3f& w) {
    return Visit(profile, [&](const auto& p) { return Falloff(p, n, w); });
}

// Returns the power as a fraction of that of the whole radiance to all sides of the normals.
float PowerFraction(const EmissionProfile& profile);

}  // namespace lull
