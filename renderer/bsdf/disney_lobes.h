// The lobes of Disney's principled material (Burley 2012 and 2015) as in pbrt-v3 (see lobes.h).
#pragma once

#include "renderer/bsdf/microfacet.h"

namespace lull {

// One of the parts that are cosine-sampled, or the base and its retro-reflection as a whole.
struct DisneyDiffuse {
    static constexpr bool kIsSpecular = false, kTransmits = false;
    enum class Part { Base, FakeSubsurface, RetroReflection, Sheen, Whole };

    StoredRgb r;
    float roughness;
    Part part;

    BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi) const {
        const float pdf = SameHemisphere(wo, wi) ? std::abs(wi.z()) * kInvPi : 0;
        return {Rgb(r) * Value(wo, wi), pdf};
    }
    bool Sample(const Vec3f& wo, const Vec2f& u, Vec3f* wi) const {
        *wi = SampleCosine(wo, u, false);
        return true;
    }

  private:
    float Value(const Vec3f& wo, const Vec3f& wi) const {
        const float cosO = std::abs(wo.z()), cosI = std::abs(wi.z());
        const float fo = SchlickWeight(cosO), fi = SchlickWeight(cosI);
        // From 1 head-on to a half at grazing angles (Burley 2015, eq. 4).
        const float base = kInvPi * (1 - fo / 2) * (1 - fi / 2);
        if (part == Part::Base) return base;
        const Vec3f h = wo + wi;
        const float h2 = h.squaredNorm();
        if (!(h2 > kMinHalf2)) return 0;
        const float cosD = 0.5f * std::sqrt(h2);
        if (part == Part::Sheen) return SchlickWeight(cosD);
        if (part == Part::RetroReflection || part == Part::Whole) {
            const float rr = 2 * roughness * Sqr(cosD);
            const float retro = kInvPi * rr * (fo + fi + fo * fi * (rr - 1));
            return part == Part::Whole ? base + retro : retro;
        }
        // Hanrahan and Krueger's approximation of scattering beneath the surface.
        const float fss90 = Sqr(cosD) * roughness;
        const float fss = Lerp(fo, 1, fss90) * Lerp(fi, 1, fss90);
        const float sum = std::max(cosO + cosI, kMinCosine);
        return kInvPi * 1.25f * (fss * (1 / sum - 0.5f) + 0.5f);
    }
};

// Blends between a dielectric and Schlick's approximation of a metal.
struct DisneyInterface {
    StoredRgb r0;
    float metallic, eta;

    Rgb operator()(float cosI) const {
        const Rgb schlick = Rgb(r0) + SchlickWeight(cosI) * (1 - Rgb(r0));
        return (1 - metallic) * FresnelDielectric(cosI, eta) + metallic * schlick;
    }
};
using DisneyReflection = MicrofacetReflection<DisneyInterface, SeparableMasking>;
using DisneyTransmission = BasicMicrofacetTransmission<SeparableMasking>;

// Reflects at a coat of index 1.5 with wide tails: normals are distributed as GTR1, and masking is
// always that of alpha = 0.25.
struct DisneyClearcoat {
    static constexpr bool kIsSpecular = false, kTransmits = false;
    StoredRgb r;
    float alpha;  // in (0, 1)

    BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi) const {
        const Vec3f h = wo + wi;
        const float h2 = h.squaredNorm();
        if (!(h2 > kMinHalf2)) return {};
        const float cosD = 0.5f * std::sqrt(h2), cosH = std::abs(h.z()) / std::sqrt(h2);
        const float d = D(cosH);
        const float fresnel = 0.04f + 0.96f * SchlickWeight(cosD);
        const float masking = Masking(std::abs(wo.z())) * Masking(std::abs(wi.z()));
        const float pdf = SameHemisphere(wo, wi) ? d * cosH / (4 * cosD) : 0;
        return {Rgb(r) * (masking * fresnel * d / 4), pdf};
    }
    bool Sample(const Vec3f& wo, const Vec2f& u, Vec3f* wi) const {
        const float alpha2 = Sqr(alpha);
        const float cos2 = std::clamp((1 - std::pow(alpha2, 1 - u.x())) / (1 - alpha2), 0.f, 1.f);
        const float sinTheta = std::sqrt(1 - cos2), phi = 2 * kPi * u.y();
        const Vec3f h(sinTheta * std::cos(phi), sinTheta * std::sin(phi),
                      std::copysign(std::sqrt(cos2), wo.z()));
        *wi = (2 * wo.dot(h)) * h - wo;
        return SameHemisphere(wo, *wi);
    }

  private:
    float D(float cosine) const {
        const float alpha2 = Sqr(alpha);
        return (alpha2 - 1) / (kPi * std::log(alpha2) * (1 + (alpha2 - 1) * Sqr(cosine)));
    }
    static float Masking(float cosine) {
        constexpr float kAlpha2 = Sqr(0.25f);
        return 1 / (cosine + std::sqrt(kAlpha2 + (1 - kAlpha2) * Sqr(cosine)));
    }
};

}  // namespace lull
