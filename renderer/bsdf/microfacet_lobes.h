// The lobes of rough interfaces. See lobes.h for the interface.
#pragma once

#include "renderer/bsdf/lobe_basics.h"

namespace lull {

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
        // wi . h / |h| is half of |h|; the interface expects it to be signed by the side of the
        // normal.
        const float cosH = std::copysign(0.5f * std::sqrt(h2), h.z());
        const Rgb f =
            Rgb(r) * (interface(cosH) * (0.5f * d / Masking::Divisor(cosO, so, cosI, si)));
        return {f, SameHemisphere(wo, wi) ? 0.5f * d / (cosO + so) : 0};
    }
    bool Sample(const Vec3f& wo, const Vec2f& u, Vec3f* wi) const {
        const Vec3f h = distribution.SampleVisibleNormal(wo, u);
        *wi = (2 * wo.dot(h)) * h - wo;
        return SameHemisphere(wo, *wi);
    }
};

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
