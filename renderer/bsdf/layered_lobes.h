// The lobes of glTF's material: a base under a rough dielectric interface, metal, anything in
// between, thin sheets, and cloth. (glTF 2.0, appendix B; KHR_materials_specular, _ior,
// _transmission, _clearcoat and _sheen.) See lobes.h for the interface.
#pragma once

#include "renderer/bsdf/microfacet.h"

namespace lull {

// The albedo of MicrofacetReflection with Schlick's reflectance, split by its two ends: the
// light reflected is f0 * ofF0 + f90 * ofF90.
struct GgxAlbedo {
    float ofF0, ofF90;

    float operator()(float f0, float f90) const { return f0 * ofF0 + f90 * ofF90; }
};

// Returns the albedo towards a direction with this cosine, in [0, 1], for an isotropic alpha in [0,
// 1]: from a table, within 0.01 of the integral.
GgxAlbedo DirectionalAlbedo(float cosine, float alpha);

// Returns its mean over all directions, weighted by the cosine.
GgxAlbedo MeanAlbedo(float alpha);

// Returns the albedo of a white CharlieSheen towards a direction with this cosine, for an alpha
// from CharlieSheen::kLeastAlpha to 1: from a table, within 0.04 of the integral. It can exceed 1
// at grazing angles where alpha is below 0.07, as the model does.
float SheenAlbedo(float cosine, float alpha);

// Computes the light that an interface with Schlick's reflectance leaves for the layer below, as in
// KHR_materials_specular: by its largest channel, so that nothing is tinted twice.
struct InterfaceAbove {
    float f0 = 0, f90 = 0;

    float Through(float cosI) const { return 1 - (f0 + (f90 - f0) * SchlickWeight(cosI)); }
};

// Stores an interface in 4 bytes, to 2^-17, since a lobe has no room for more.
class StoredInterface {
  public:
    StoredInterface(const InterfaceAbove& i) : f0(Store(i.f0)), f90(Store(i.f90)) {}
    operator InterfaceAbove() const { return {float(f0) / 65535, float(f90) / 65535}; }

  private:
    static uint16_t Store(float v) { return uint16_t(std::clamp(v, 0.f, 1.f) * 65535 + 0.5f); }
    uint16_t f0, f90;
};

// A clear coat with an index of 1.5, in 4 bytes. By the direction of view alone it takes what it
// reflects there from all that is below, as KHR_materials_clearcoat mixes them: no light is lost or
// made, but f is not reciprocal.
class CoatAbove {
  public:
    CoatAbove(float weight, float alpha = 0)
        : weight(uint16_t(weight * 65535 + 0.5f)), alpha(uint16_t(alpha * 65535 + 0.5f)) {}

    float Through(float cosO) const {
        if (weight == 0) return 1;
        const float reflected = alpha <= kSmooth
                                    ? 0.04f + 0.96f * SchlickWeight(cosO)
                                    : DirectionalAlbedo(cosO, float(alpha) / 65535)(0.04f, 1);
        return 1 - float(weight) / 65535 * reflected;
    }

  private:
    // 0.001: between it and the next row of the table, the latter is 0.04 too low at the horizon.
    static constexpr uint16_t kSmooth = 66;
    uint16_t weight, alpha;  // in units of 1 / 65535
};

// Follows Schlick's approximation from f0 to f90, below a clear coat.
struct CoatedInterface {
    StoredRgb f0;
    float f90;
    CoatAbove coat;

    Rgb operator()(float cosI) const {
        const Rgb r = f0;
        return r + SchlickWeight(std::abs(cosI)) * (f90 - r);
    }
};

// Follows Fresnel's formula for an index of `eta` >= 1, stretched to go from f0 to f90, as in the
// Principled BSDF of Blender 3; of index 1 it is f0 at all angles.
struct StretchedInterface {
    StoredRgb f0;
    float f90, eta;

    Rgb operator()(float cosI) const {
        const Rgb r = f0;
        const float least = Sqr((eta - 1) / (eta + 1));
        const float rise = FresnelDielectric(std::abs(cosI), eta) - least;
        return r + (f90 - r) * (std::max(rise, 0.f) / (1 - least));
    }
};

// Reflects diffusely below a rough interface and glossily at it. Both share one distribution of
// microfacets and Schlick's reflectance from f0 to f90; metal is an interface without a base.
//
// Appendix B scales the base by 1 - F of the half vector and allows better methods, as the sum can
// exceed 1 at grazing angles. Here the base gets the fraction that the whole interface does not
// reflect, once for each direction (Kelemen and Szirmay-Kalos 2001): reciprocal, and a white base
// reflects all light.
struct LayeredReflection {
    static constexpr bool kIsSpecular = false, kTransmits = false;
    StoredRgb diffuse;  // albedo of the base / (1 - mean albedo of the interface above it)
    StoredRgb f0;
    float f90;
    float alpha;
    StoredInterface stored;          // above the base
    CoatAbove coat;                  // over all
    StoredRgb scale = Rgb(1, 1, 1);  // sampling does not depend on it

    // Takes the albedo of the base, in [0, 1], and the rest as the members.
    LayeredReflection(const Rgb& base, const Rgb& f0, float f90, float alpha,
                      const InterfaceAbove& above, CoatAbove coat)
        : diffuse(base), f0(f0), f90(f90), alpha(alpha), stored(above), coat(coat) {
        const float left = 1 - MeanAlbedo(alpha)(above.f0, above.f90);
        diffuse *= Rgb::Constant(left > 1e-3f ? 1 / left : 0);
    }

    BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi) const {
        const float cosO = std::abs(wo.z()), cosI = std::abs(wi.z());
        if (std::min(cosO, cosI) < kMinCosine) return {};
        const Split split = SplitOf(cosO);
        const InterfaceAbove above = stored;
        BsdfValue value;
        if (split.through > 0) {
            const GgxAlbedo albedo = DirectionalAlbedo(cosI, alpha);
            const float through = std::max(0.f, 1 - albedo(above.f0, above.f90));
            value.f = Rgb(diffuse) * (kInvPi * split.through * through);
            value.pdf = split.diffuseShare * cosI * kInvPi;
        }
        const Vec3f h = wo + wi;
        const float h2 = h.squaredNorm();
        if (h2 > kMinHalf2 && split.diffuseShare < 1) {
            const TrowbridgeReitz distribution(alpha, alpha);
            const float d = distribution.D(h, h2);
            const float so = distribution.Stretch(wo), si = distribution.Stretch(wi);
            const Rgb r = f0;
            const Rgb reflectance = r + SchlickWeight(0.5f * std::sqrt(h2)) * (f90 - r);
            value.f += reflectance * (0.5f * d / (cosI * so + cosO * si));
            value.pdf += (1 - split.diffuseShare) * (0.5f * d / (cosO + so));
        }
        value.f *= Rgb(scale) * coat.Through(cosO);
        if (!SameHemisphere(wo, wi)) value.pdf = 0;
        return value;
    }
    bool Sample(const Vec3f& wo, const Vec2f& u, Vec3f* wi) const {
        const float share = SplitOf(std::abs(wo.z())).diffuseShare;
        if (u.x() < share) {
            *wi = SampleCosine(wo, {std::min(u.x() / share, kOneMinusEpsilon), u.y()}, false);
            return true;
        }
        const Vec2f v(std::min((u.x() - share) / (1 - share), kOneMinusEpsilon), u.y());
        const Vec3f h = TrowbridgeReitz(alpha, alpha).SampleVisibleNormal(wo, v);
        *wi = (2 * wo.dot(h)) * h - wo;
        return SameHemisphere(wo, *wi);
    }

  private:
    // Fraction of the light from one direction that reaches the base, and the probability of
    // sampling the base: its fraction of the light that it and the interface reflect.
    struct Split {
        float through = 0, diffuseShare = 0;
    };
    Split SplitOf(float cosO) const {
        const float base = diffuse.r + diffuse.g + diffuse.b;
        if (!(base > 0)) return {};
        const InterfaceAbove above = stored;
        const GgxAlbedo albedo = DirectionalAlbedo(cosO, alpha);
        const float through = std::max(0.f, 1 - albedo(above.f0, above.f90));
        const float atBase = through * base;
        const float atInterface = albedo(f0.r + f0.g + f0.b, 3 * f90);
        const float sum = atBase + atInterface;
        return {through, sum > 0 ? atBase / sum : 1};
    }
};

// Transmits through a sheet too thin to refract, blurred by the roughness of its surface: the
// reflection of LayeredReflection's interface continues on the other side instead, by 1 - F.
struct ThinTransmission {
    static constexpr bool kIsSpecular = false, kTransmits = true;
    StoredRgb t;
    float alpha;
    InterfaceAbove above;
    CoatAbove coat;

    BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi) const {
        const float cosO = std::abs(wo.z()), cosI = std::abs(wi.z());
        if (std::min(cosO, cosI) < kMinCosine || SameHemisphere(wo, wi)) return {};
        const Vec3f h = wo + Mirrored(wi);
        const float h2 = h.squaredNorm();
        if (!(h2 > kMinHalf2)) return {};
        const TrowbridgeReitz distribution(alpha, alpha);
        const float d = distribution.D(h, h2);
        const float so = distribution.Stretch(wo), si = distribution.Stretch(wi);
        const float through = above.Through(0.5f * std::sqrt(h2)) * coat.Through(cosO);
        return {Rgb(t) * (through * (0.5f * d / (cosI * so + cosO * si))), 0.5f * d / (cosO + so)};
    }
    bool Sample(const Vec3f& wo, const Vec2f& u, Vec3f* wi) const {
        const Vec3f h = TrowbridgeReitz(alpha, alpha).SampleVisibleNormal(wo, u);
        const Vec3f reflected = (2 * wo.dot(h)) * h - wo;
        *wi = Mirrored(reflected);
        return SameHemisphere(wo, reflected);
    }

  private:
    static Vec3f Mirrored(const Vec3f& w) { return {w.x(), w.y(), -w.z()}; }
};

// Represents a smooth sheet: reflects as a mirror or lets light straight through.
struct ThinSpecular {
    static constexpr bool kIsSpecular = true, kTransmits = true;
    StoredRgb f0;
    float f90;
    StoredRgb t;
    StoredInterface stored;
    CoatAbove coat;
    StoredRgb scale = Rgb(1, 1, 1);  // sampling does not depend on it

    // Returns the share of light that goes straight through at this cosine, > 0.
    Rgb StraightThrough(float cosine) const {
        const InterfaceAbove above = stored;
        return Rgb(t) * Rgb(scale) * (std::max(0.f, above.Through(cosine)) * coat.Through(cosine));
    }

    bool Sample(const Vec3f& wo, const Vec2f& u, SpecularSample* s) const {
        const float cosO = std::abs(wo.z());
        const InterfaceAbove above = stored;
        const Rgb r = f0;
        const Rgb reflected = r + SchlickWeight(cosO) * (f90 - r);
        const Rgb through = Rgb(t) * std::max(0.f, above.Through(cosO));
        const float sum = reflected.sum() + through.sum();
        if (!(sum > 0)) return false;
        const float share = reflected.sum() / sum;
        const Rgb f = Rgb(scale) * (coat.Through(cosO) / cosO);
        if (u.x() < share)
            *s = {reflected * f, share, {-wo.x(), -wo.y(), wo.z()}, false};
        else
            *s = {through * f, 1 - share, -wo, true};
        return true;
    }
};

// Computes Smith's auxiliary function of the distribution below, as fitted by Estevez and Kulla.
class CharlieMasking {
  public:
    explicit CharlieMasking(float alpha) : t(Sqr(1 - alpha)), middle(L(0.5f)) {}

    // `cosine` in [0, 1].
    float Lambda(float cosine) const {
        return std::exp(cosine < 0.5f ? L(cosine) : 2 * middle - L(std::max(0.f, 1 - cosine)));
    }

  private:
    float L(float x) const {
        return Lerp(t, 21.5473f, 25.3245f) /
                   (1 + Lerp(t, 3.82987f, 3.32435f) * std::pow(x, Lerp(t, 0.19823f, 0.16801f))) +
               Lerp(t, -1.9776f, -1.27393f) * x + Lerp(t, -4.32054f, -4.85967f);
    }

    float t, middle;
};

// Reflects at fibres that are distributed as a power of the sine ("Charlie"; Estevez and Kulla
// 2017, "Production Friendly Microfacet Sheen BRDF").
struct CharlieSheen {
    static constexpr bool kIsSpecular = false, kTransmits = false;
    StoredRgb r;
    float alpha;  // in [kLeastAlpha, 1]

    // Below it the rim would be narrower than its table of albedos resolves.
    static constexpr float kLeastAlpha = 0.01f;

    BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi) const {
        // Behind a tilted normal light comes for that from opposite, which the surface hides.
        const bool isBehind = !SameHemisphere(wo, wi);
        const Vec3f h = isBehind ? Vec3f(wo - wi) : Vec3f(wo + wi);
        const float h2 = h.squaredNorm();
        const float cosO = std::abs(wo.z()), cosI = std::abs(wi.z());
        if (std::min(cosO, cosI) < kMinCosine || !(h2 > kMinHalf2)) return {};
        const float sin2 = std::clamp((Sqr(h.x()) + Sqr(h.y())) / h2, 0.f, 1.f);
        const float d = (2 + 1 / alpha) * std::pow(sin2, 0.5f / alpha) * (0.5f * kInvPi);
        const CharlieMasking masking(alpha);
        // Nearer to the horizon the fit would give more light than comes in.
        const float o = std::max(cosO, 1e-3f), i = std::max(cosI, 1e-3f);
        const float f = d / (4 * o * i * (1 + masking.Lambda(o) + masking.Lambda(i)));
        return {Rgb(r) * f, isBehind ? 0 : cosI * kInvPi};
    }
    bool Sample(const Vec3f& wo, const Vec2f& u, Vec3f* wi) const {
        *wi = SampleCosine(wo, u, false);
        return true;
    }
};

}  // namespace lull
