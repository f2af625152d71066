// Models how a medium scatters light (Henyey and Greenstein 1941).
#pragma once

#include "renderer/base/math.h"

namespace lull {

// Returns the density of scattering, 1/sr, between the direction that light comes from and the one
// it goes to, both pointing away; `cosine` is that of the angle between them. g in (-1, 1) is the
// mean cosine of the deflection: positive for forward scattering.
inline float PhaseHenyeyGreenstein(float cosine, float g) {
    const float q = std::max(1 + Sqr(g) + 2 * g * cosine, 1e-12f);
    return (1 - Sqr(g)) / (4 * kPi * q * std::sqrt(q));
}

// Chooses wi with that density, for wo unit.
inline Vec3f SampleHenyeyGreenstein(const Vec3f& wo, float g, const Vec2f& u) {
    float cosine = 1 - 2 * u.x();
    if (std::abs(g) >= 1e-3f) {
        const float root = (1 - Sqr(g)) / (1 + g - 2 * g * u.x());
        cosine = std::clamp(-(1 + Sqr(g) - Sqr(root)) / (2 * g), -1.f, 1.f);
    }
    const float sine = SafeSqrt(1 - Sqr(cosine)), phi = 2 * kPi * u.y();
    Vec3f s, t;
    CoordinateSystem(wo, &s, &t);
    return (sine * std::cos(phi) * s + sine * std::sin(phi) * t + cosine * wo).normalized();
}

}  // namespace lull
