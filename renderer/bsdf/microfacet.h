// Describes rough surfaces by the distribution of their microscopic normals.
#pragma once

#include "renderer/base/sampling.h"

namespace lull {

// Maps pbrt's perceptual roughness in [0, 1] to Trowbridge-Reitz' alpha, as pbrt-v3 does
// (a polynomial in the logarithm; 1 gives 1.62, everything below 0.001 counts as 0.001).
inline float RoughnessToAlpha(float roughness) {
    const float x = std::log(std::max(1e-3f, roughness));
    return 1.62142f + x * (0.819955f + x * (0.1734f + x * (0.0171201f + x * 0.000640711f)));
}

// Represents the anisotropic Trowbridge-Reitz (GGX) distribution (Walter et al. 2007; Heitz 2014,
// JCGT 3(2)) with Smith's height-correlated masking. Directions are local; neither value depends on
// the side of the surface.
class TrowbridgeReitz {
  public:
    // As in pbrt-v3, both alphas are at least 0.001, where float still resolves the peak.
    TrowbridgeReitz(float alphaX, float alphaY)
        : alphaX(std::max(1e-3f, alphaX)), alphaY(std::max(1e-3f, alphaY)) {}

    float AlphaX() const { return alphaX; }
    float AlphaY() const { return alphaY; }

    // Returns the density of normals along h, 1/sr. h need not be unit; `length2` is its squared
    // length, not 0.
    float D(const Vec3f& h, float length2) const {
        const float a = alphaX * alphaY;
        const float q = Sqr(alphaY * h.x()) + Sqr(alphaX * h.y()) + Sqr(a * h.z());
        return kInvPi * a * Sqr(a) * Sqr(length2 / q);
    }

    // Returns |cos w| (1 + 2 Lambda(w)), Lambda being Smith's auxiliary function. With it Smith's
    // masking needs no tangents and stays finite at grazing angles: G1(w) = 2 |cos w| /
    // (|cos w| + Stretch(w)), and G(v, w) = 2 |cos v cos w| / (|cos v| Stretch(w) + |cos w|
    // Stretch(v)).
    float Stretch(const Vec3f& w) const {
        return std::sqrt(Sqr(w.z()) + Sqr(alphaX * w.x()) + Sqr(alphaY * w.y()));
    }

    // Chooses a unit normal h on the side of the unit direction w, with the density of those
    // visible from w: D(h) G1(w) |w . h| / |cos w|. (Dupuy and Benyoub 2023, "Sampling Visible GGX
    // Normals with Spherical Caps"; written so that nothing cancels.)
    Vec3f SampleVisibleNormal(const Vec3f& w, const Vec2f& u) const {
        const float side = std::copysign(1.f, w.z());
        const Vec3f v = (side * Vec3f(alphaX * w.x(), alphaY * w.y(), w.z())).normalized();
        const float t = u.x() * (1 + v.z()), r = SafeSqrt(t * (2 - t));
        const auto [s, c] = SineCosineOfTurn(u.y());
        const Vec3f h(r * c + v.x(), r * s + v.y(), (1 - u.x()) * (1 + v.z()));
        return Vec3f(alphaX * h.x(), alphaY * h.y(), h.z()).normalized() * side;
    }

  private:
    float alphaX, alphaY;
};

}  // namespace lull
