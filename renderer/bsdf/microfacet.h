// Describes rough surfaces by the distribution of their microscopic normals.
#pragma once

#include "renderer/base/sampling.h"
#include "renderer/bsdf/fresnel.h"

namespace lull {

// Maps pbrt's perceptual roughness in [0, 1] to Trowbridge-Reitz' alpha, as pbrt-v3 does
// (a polynomial in the logarithm; 1 gives 1.62, everything below 0.001 counts as 0.001).
inline float RoughnessToAlpha(float roughness) {
    const float x = std::log(std::max(1e-3f, roughness));
    return 1.62142f + x * (0.819955f + x * (0.1734f + x * (0.0171201f + x * 0.000640711f)));
}

// Represents the anisotropic Trowbridge-Reitz (GGX) distribution (Walter et al. 2007; Heitz 2014,
// JCGT 3(2)) with Smith's height-correlated masking. Directions are local, of either side.
class TrowbridgeReitz {
  public:
    // As in pbrt-v3, both alphas are at least 0.001, where float still resolves the peak.
    TrowbridgeReitz(float alphaX, float alphaY)
        : alphaX(std::max(1e-3f, alphaX)), alphaY(std::max(1e-3f, alphaY)) {}

    float AlphaX() const { return alphaX; }
    float AlphaY() const { return alphaY; }

    // Returns the density of normals along h, 1/sr. `length2` is |h|^2, not 0.
    float D(const Vec3f& h, float length2) const {
        const float a = alphaX * alphaY;
        const float q = Sqr(alphaY * h.x()) + Sqr(alphaX * h.y()) + Sqr(a * h.z());
        return kInvPi * a * Sqr(a) * Sqr(length2 / q);
    }

    // Returns |cos w| (1 + 2 Lambda(w)), Lambda being Smith's auxiliary function. Smith's masking
    // by it stays finite at grazing angles: G1(w) = 2 |cos w| / (|cos w| + Stretch(w)), and G(v, w)
    // = 2 |cos v cos w| / (|cos v| Stretch(w) + |cos w| Stretch(v)).
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

struct BsdfValue {
    Rgb f = Rgb::Zero();  // 1/sr
    float pdf = 0;        // 1/sr
};

struct SpecularSample {
    Rgb f;  // times |cos wi| / pdf is the weight
    float pdf;
    Vec3f wi;
    bool isTransmission;
};

inline bool SameHemisphere(const Vec3f& a, const Vec3f& b) { return a.z() * b.z() > 0; }

// Cosine-samples wi, on the side of wo or on the other side.
inline Vec3f SampleCosine(const Vec3f& wo, const Vec2f& u, bool otherSide) {
    Vec3f wi = SampleCosineHemisphere(u);
    if ((wo.z() < 0) != otherSide) wi.z() = -wi.z();
    return wi;
}

// Below this squared length a half vector is rounding error: wo and wi are opposite. Below this
// cosine a direction lies in the surface. Together they keep all quotients within float.
inline constexpr float kMinHalf2 = 1e-14f, kMinCosine = 1e-12f;

// Compute the share of microfacets that two directions both see: G(v, w) = 2 |cos v cos w| /
// Divisor, in terms of their cosines and TrowbridgeReitz::Stretch. Correlated: Smith's masking with
// the same height of microfacets for both directions. Separable: each direction by itself, G1(v)
// G1(w).
struct CorrelatedMasking {
    static float Divisor(float cosV, float stretchV, float cosW, float stretchW) {
        return cosW * stretchV + cosV * stretchW;
    }
};
struct SeparableMasking {
    static float Divisor(float cosV, float stretchV, float cosW, float stretchW) {
        return 0.5f * (cosV + stretchV) * (cosW + stretchW);
    }
};

// Reflects at microfacets (Torrance and Sparrow 1967; Walter et al. 2007, eq. 20).
template <typename Interface, typename Masking = CorrelatedMasking>
struct MicrofacetReflection {
    static constexpr bool kIsSpecular = false, kTransmits = false;
    StoredRgb r;
    TrowbridgeReitz distribution;
    Interface interface;

    BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi) const {
        const Vec3f h = wo + wi;
        const float h2 = h.squaredNorm();
        const float cosO = std::abs(wo.z()), cosI = std::abs(wi.z());
        if (std::min(cosO, cosI) < kMinCosine || !(h2 > kMinHalf2)) return {};
        const float d = distribution.D(h, h2);
        const float so = distribution.Stretch(wo), si = distribution.Stretch(wi);
        // wi . h / |h| is half of |h|; the interface wants it signed by the normal's side.
        const float cosH = std::copysign(0.5f * std::sqrt(h2), h.z());
        Rgb f = Rgb(r) * (interface(cosH) * (0.5f * d / Masking::Divisor(cosO, so, cosI, si)));
        if constexpr (requires { interface.coat; }) f *= interface.coat.Through(cosO);
        return {f, SameHemisphere(wo, wi) ? 0.5f * d / (cosO + so) : 0};
    }
    bool Sample(const Vec3f& wo, const Vec2f& u, Vec3f* wi) const {
        const Vec3f h = distribution.SampleVisibleNormal(wo, u);
        *wi = (2 * wo.dot(h)) * h - wo;
        return SameHemisphere(wo, *wi);
    }
};

// Keeps the index of a rough interface away from 1, where half vectors would be rounding errors.
inline float ResolvableIndex(float eta) { return std::abs(eta - 1) < 1e-4f ? 1.0001f : eta; }

// Refracts at microfacets (Walter et al. 2007, eq. 21). The index is 1 on the normal's side. As in
// pbrt-v3, f and the density do not vanish for microfacets that wo sees from behind, though these
// are never sampled: light sampling finds them, and the density integrates to more than 1.
template <typename Masking>
struct BasicMicrofacetTransmission {
    static constexpr bool kIsSpecular = false, kTransmits = true;
    StoredRgb t;
    TrowbridgeReitz distribution;
    float eta;  // index beyond the surface

    BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi) const {
        const float cosO = std::abs(wo.z()), cosI = std::abs(wi.z());
        if (std::min(cosO, cosI) < kMinCosine || SameHemisphere(wo, wi)) return {};
        const float ratio = wo.z() > 0 ? eta : 1 / eta;
        const Vec3f h = wo + ratio * wi;  // its length is the root of the Jacobian's denominator
        const float h2 = h.squaredNorm(), oh = wo.dot(h), ih = wi.dot(h);
        if (!(h2 > kMinHalf2) || oh * ih > 0) return {};
        const float so = distribution.Stretch(wo), si = distribution.Stretch(wi);
        const float cosH = std::copysign(oh / std::sqrt(h2), oh * h.z());
        const float common = 2 * distribution.D(h, h2) * std::abs(oh * ih) / Sqr(h2);
        const float through = 1 - FresnelDielectric(cosH, eta);
        return {Rgb(t) * (through * common / Masking::Divisor(cosO, so, cosI, si)),
                common * Sqr(ratio) / (cosO + so)};
    }
    bool Sample(const Vec3f& wo, const Vec2f& u, Vec3f* wi) const {
        const Vec3f h = distribution.SampleVisibleNormal(wo, u);
        if (!Refract(wo, h, wo.z() > 0 ? 1 / eta : eta, wi)) return false;
        // A steep microfacet may refract back to where the light came from.
        return !SameHemisphere(wo, *wi);
    }
};

using MicrofacetTransmission = BasicMicrofacetTransmission<CorrelatedMasking>;

}  // namespace lull
