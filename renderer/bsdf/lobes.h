// The lobes that Bsdfs are made of: plain structs in the local frame, the shading normal
// along +z. All directions are unit and point away from the surface.
//
// A lobe that spreads light has (pbrt-v3's values and densities throughout)
//     BsdfValue Evaluate(wo, wi)       f, and the density with which Sample finds wi;
//     bool Sample(wo, u, &wi)          chooses wi; false where nothing can be scattered,
// a perfectly specular one has
//     bool Sample(wo, u, &sample)      chooses among the few directions there are.
// Both demand wo.z != 0 for Sample only. f is for radiance, not importance: transmission scales it
// by the square of the indices' ratio. A lobe that has kIsTwoSided scatters to both sides; if it
// has kTellsSides as well, light that both normals take for reflected, or both for transmitted. As
// in pbrt-v3, f of a reflecting lobe does not ask whether wo and wi lie on the same side of the
// shading normal (Bsdf asks the geometric one), the density does.
#pragma once

#include <variant>

#include "renderer/base/variant.h"
#include "renderer/bsdf/coat.h"
#include "renderer/bsdf/disney_lobes.h"
#include "renderer/bsdf/fourier_lobe.h"
#include "renderer/bsdf/hair_lobe.h"
#include "renderer/bsdf/layered_lobes.h"
#include "renderer/bsdf/microfacet.h"
#include "renderer/bsdf/subsurface.h"

namespace lull {

struct LambertianReflection {
    static constexpr bool kIsSpecular = false, kTransmits = false;
    StoredRgb r;

    BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi) const {
        return {Rgb(r) * kInvPi, SameHemisphere(wo, wi) ? std::abs(wi.z()) * kInvPi : 0};
    }
    bool Sample(const Vec3f& wo, const Vec2f& u, Vec3f* wi) const {
        *wi = SampleCosine(wo, u, false);
        return true;
    }
};

struct LambertianTransmission {
    static constexpr bool kIsSpecular = false, kTransmits = true;
    StoredRgb t;

    BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi) const {
        return {Rgb(t) * kInvPi, SameHemisphere(wo, wi) ? 0 : std::abs(wi.z()) * kInvPi};
    }
    bool Sample(const Vec3f& wo, const Vec2f& u, Vec3f* wi) const {
        *wi = SampleCosine(wo, u, true);
        return true;
    }
};

// A surface of V-shaped Lambertian grooves (Oren and Nayar 1994, the qualitative model, eq. 30).
struct OrenNayar {
    static constexpr bool kIsSpecular = false, kTransmits = false;
    StoredRgb r;
    float a, b;

    // `sigma` is the deviation of the grooves' slope angles in degrees, > 0.
    OrenNayar(const Rgb& r, float sigma) : r(r) {
        const float s2 = Sqr(sigma * (kPi / 180));
        a = 1 - s2 / (2 * (s2 + 0.33f));
        b = 0.45f * s2 / (s2 + 0.09f);
    }

    BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi) const {
        // max(0, cos dphi) sin(alpha) tan(beta), alpha and beta being the larger and the smaller
        // of the two angles: both sines are in the product of the tangential parts.
        const float across = wo.x() * wi.x() + wo.y() * wi.y();
        const float cosBeta = std::max({std::abs(wo.z()), std::abs(wi.z()), 1e-30f});
        const float f = kInvPi * (a + b * std::max(0.f, across) / cosBeta);
        return {Rgb(r) * f, SameHemisphere(wo, wi) ? std::abs(wi.z()) * kInvPi : 0};
    }
    bool Sample(const Vec3f& wo, const Vec2f& u, Vec3f* wi) const {
        *wi = SampleCosine(wo, u, false);
        return true;
    }
};

template <typename Interface>
struct SpecularReflection {
    static constexpr bool kIsSpecular = true, kTransmits = false;
    StoredRgb r;
    Interface interface;

    bool Sample(const Vec3f& wo, const Vec2f&, SpecularSample* s) const {
        *s = {
            Rgb(r) * (interface(wo.z()) / std::abs(wo.z())), 1, {-wo.x(), -wo.y(), wo.z()}, false};
        return true;
    }
};

// Refracts at a smooth interface. The index is 1 on the normal's side.
struct SpecularTransmission {
    static constexpr bool kIsSpecular = true, kTransmits = true;
    StoredRgb t;
    float eta;  // index beyond the surface

    bool Sample(const Vec3f& wo, const Vec2f&, SpecularSample* s) const {
        const float ratio = wo.z() > 0 ? 1 / eta : eta;
        if (!Refract(wo, {0, 0, std::copysign(1.f, wo.z())}, ratio, &s->wi)) return false;
        s->f = Rgb(t) * ((1 - FresnelDielectric(wo.z(), eta)) * Sqr(ratio) / std::abs(s->wi.z()));
        s->pdf = 1;
        s->isTransmission = true;
        return true;
    }
};

// Represents a smooth dielectric: reflects or refracts, chosen by Fresnel's reflectance.
struct FresnelSpecular {
    static constexpr bool kIsSpecular = true, kTransmits = true;
    StoredRgb r, t;
    float eta;  // index beyond the surface; 1 on the normal's side

    bool Sample(const Vec3f& wo, const Vec2f& u, SpecularSample* s) const {
        const float reflectance = FresnelDielectric(wo.z(), eta);
        if (u.x() < reflectance) {
            *s = {Rgb(r) * (reflectance / std::abs(wo.z())),
                  reflectance,
                  {-wo.x(), -wo.y(), wo.z()},
                  false};
            return true;
        }
        const float ratio = wo.z() > 0 ? 1 / eta : eta;
        if (!Refract(wo, {0, 0, std::copysign(1.f, wo.z())}, ratio, &s->wi)) return false;
        s->pdf = 1 - reflectance;
        s->f = Rgb(t) * (s->pdf * Sqr(ratio) / std::abs(s->wi.z()));
        s->isTransmission = true;
        return true;
    }
};

// Represents a diffuse layer under a glossy coat (Ashikhmin and Shirley 2000, "An Anisotropic
// Phong BRDF Model", with pbrt's microfacet distribution).
struct FresnelBlend {
    static constexpr bool kIsSpecular = false, kTransmits = false;
    StoredRgb rd, rs;
    TrowbridgeReitz distribution;
    StoredRgb scale = Rgb(1, 1, 1);  // f is not linear in rs
    float glossyShare = 0.5f;        // of the samples, in (0, 1)

    BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi) const {
        const Vec3f h = wo + wi;
        const float h2 = h.squaredNorm();
        const float cosO = std::abs(wo.z()), cosI = std::abs(wi.z());
        const float cosMax = std::max(cosO, cosI);
        if (cosMax < kMinCosine || !(h2 > kMinHalf2)) return {};
        const auto fade = [](float c) {
            const float v = 1 - 0.5f * c;
            return 1 - Sqr(Sqr(v)) * v;
        };
        const float d = distribution.D(h, h2), cosH = 0.5f * std::sqrt(h2);
        const Rgb s = rs;
        const Rgb diffuse = (28 / (23 * kPi) * fade(cosO) * fade(cosI)) * Rgb(rd) * (1 - s);
        const Rgb glossy = FresnelSchlick(s, cosH) * (d / (4 * cosH * cosMax));
        const Rgb f = Rgb(scale) * (diffuse + glossy);
        if (!SameHemisphere(wo, wi)) return {f, 0};
        const float glossyPdf = 0.5f * d / (cosO + distribution.Stretch(wo));
        // Equal shares are rounded as pbrt-v3's estimator always was: once, on machines that fuse
        // product and sum. A product shared by both lines would be rounded by itself.
        if (glossyShare == 0.5f) return {f, cosI * (0.5f * kInvPi) + 0.5f * glossyPdf};
        return {f, (1 - glossyShare) * (cosI * kInvPi) + glossyShare * glossyPdf};
    }
    bool Sample(const Vec3f& wo, const Vec2f& u, Vec3f* wi) const {
        const float diffuseShare = 1 - glossyShare;
        if (u.x() < diffuseShare) {
            const float x = std::min(u.x() / diffuseShare, kOneMinusEpsilon);
            *wi = SampleCosine(wo, {x, u.y()}, false);
            return true;
        }
        const Vec2f v(std::min((u.x() - diffuseShare) / glossyShare, kOneMinusEpsilon), u.y());
        const Vec3f h = distribution.SampleVisibleNormal(wo, v);
        *wi = (2 * wo.dot(h)) * h - wo;
        return SameHemisphere(wo, *wi);
    }
};

using Lobe =
    std::variant<std::monostate, LambertianReflection, LambertianTransmission, OrenNayar,
                 MicrofacetReflection<DielectricInterface>,
                 MicrofacetReflection<ConductorInterface>, MicrofacetTransmission,
                 SpecularReflection<PerfectMirror>, SpecularReflection<DielectricInterface>,
                 SpecularReflection<ConductorInterface>, SpecularTransmission, FresnelSpecular,
                 FresnelBlend, DisneyDiffuse, DisneyReflection, DisneyTransmission, DisneyClearcoat,
                 HairLobe, FourierLobe, LayeredReflection, MicrofacetReflection<SchlickInterface>,
                 ThinTransmission, ThinSpecular, DiffuseExit, CharlieSheen,
                 MicrofacetReflection<CoatedInterface>, SpecularReflection<StretchedInterface>,
                 MicrofacetReflection<StretchedInterface, SeparableMasking>, CoatedDiffuseLobe,
                 SpecularReflection<CoatInterface>, SpecularReflection<CoatedConductorInterface>,
                 CoatedConductorLobe, ThinDielectricLobe>;
static_assert(std::is_trivially_copyable_v<Lobe> && sizeof(Lobe) <= 56);

// Returns the lobe with f multiplied by `scale`; its sampling is the same.
Lobe Scaled(const Lobe& lobe, const Rgb& scale);

// Estimates the share of uniform light that the lobe scatters to wo (z != 0), ignoring roughness,
// as a luminance.
float EstimatedAlbedo(const Lobe& lobe, const Vec3f& wo);

// Makes a FresnelBlend choose between its parts by the light that they scatter to wo, but each of
// them with a probability of at least `least`; leaves other lobes alone.
void ChoosePartsByShare(const Vec3f& wo, float least, Lobe* lobe);

// Calls f with the lobe inside; f must accept every kind and return the same type for all.
template <typename F>
[[gnu::always_inline]] inline auto VisitLobe(const Lobe& lobe, F&& f) {
    return Visit<1>(lobe, f);
}

template <typename L>
constexpr bool IsMirrorLike() {
    constexpr bool isDiffuse = std::is_same_v<L, LambertianReflection> ||
                               std::is_same_v<L, OrenNayar> || std::is_same_v<L, DisneyDiffuse> ||
                               std::is_same_v<L, DiffuseExit> || std::is_same_v<L, CharlieSheen>;
    constexpr bool reflects = !L::kTransmits || std::is_same_v<L, FresnelSpecular> ||
                              std::is_same_v<L, ThinSpecular> ||
                              std::is_same_v<L, ThinDielectricLobe>;
    return reflects && !isDiffuse && !requires { L::kIsTwoSided; };
}
inline bool Mirrors(const Lobe& lobe) {
    return VisitLobe(lobe, []<typename L>(const L&) { return IsMirrorLike<L>(); });
}

inline bool IsSpecular(const Lobe& lobe) {
    return VisitLobe(lobe, [](const auto& l) { return l.kIsSpecular; });
}

}  // namespace lull
