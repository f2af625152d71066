// The lobes of surfaces under a dielectric coat, as pbrt-v4 has them: light crosses the coat, is
// scattered by the base, and goes to and fro between both. The coat lies on both sides of the
// surface. See lobes.h for the interface of lobes.
#pragma once

#include <array>
#include <vector>

#include "renderer/bsdf/microfacet.h"

namespace lull {

// A coat of one roughness over a diffuse base: how much light it lets through.
struct CoatRow {
    static constexpr int kCosines = 17;

    float eta = 1.5f, thickness = 0.01f;  // index; the light loses exp(-thickness / |cos|)
    bool isSmooth = true;
    // Share of a diffuse flux from the base that comes back to it, and that leaves.
    float returned = 0, escaping = 0;
    // Share that reaches the base of light with a cosine of CosineAt(i); of rough coats.
    std::array<float, kCosines> through{};

    // Grazing first, then the middles of 16 steps.
    static float CosineAt(int i) { return i == 0 ? 1e-3f : (float(i) - 0.5f) / (kCosines - 1); }

    // Returns the share that reaches the base, of light at this cosine, > 0.
    float Through(float cosine) const;
};

// Integrates the row of an isotropic alpha; 0: smooth.
CoatRow MakeCoatRow(float alpha, float eta, float thickness);

// The rows of a coat whose alpha varies, between 0.001 and 1, or of one that is the same all over.
class CoatTable {
  public:
    CoatTable(float alpha, float eta, float thickness);
    CoatTable(float eta, float thickness);

    // Returns the row of smooth coats, or the row below an alpha; *blend is the share of the next.
    const CoatRow* RowOf(float alpha, float* blend) const;

  private:
    std::vector<CoatRow> rows;  // the smooth one, then by the root of alpha
    bool isConstant;
};

// A dielectric interface that is the same from both sides.
struct CoatInterface {
    float eta;
    float operator()(float cosine) const { return FresnelDielectric(std::abs(cosine), eta); }
};

// A diffuse base under a coat, and the reflection of the coat where that is rough. Crossings are
// independent, so that light to and fro is a geometric series (five terms, as pbrt-v4's walk).
struct CoatedDiffuseLobe {
    static constexpr bool kIsSpecular = false, kTransmits = false;
    StoredRgb base;  // albedo, in [0, 1]
    TrowbridgeReitz distribution;
    StoredPointer<CoatRow> row;  // of a table that outlives the lobe
    float blend;                 // share of row[1]
    StoredRgb scale = Rgb(1, 1, 1);

    BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi) const {
        const float cosO = std::abs(wo.z()), cosI = std::abs(wi.z());
        if (std::min(cosO, cosI) < kMinCosine || !SameHemisphere(wo, wi)) return {};
        BsdfValue value;
        value.f = Series() * (kInvPi * Through(cosO) * Through(cosI) / Sqr(row->eta));
        value.pdf = cosI * kInvPi;
        const Vec3f h = wo + wi;
        const float h2 = h.squaredNorm();
        if (!row->isSmooth && h2 > kMinHalf2) {
            const float share = CoatShare(cosO), d = distribution.D(h, h2);
            const float so = distribution.Stretch(wo), si = distribution.Stretch(wi);
            const float f = FresnelDielectric(0.5f * std::sqrt(h2), row->eta);
            value.f += Rgb::Constant(f * 0.5f * d / (cosI * so + cosO * si));
            value.pdf += share * (0.5f * d / (cosO + so) - value.pdf);
        }
        value.f *= Rgb(scale);
        return value;
    }
    bool Sample(const Vec3f& wo, const Vec2f& u, Vec3f* wi) const {
        const float share = row->isSmooth ? 0 : CoatShare(std::abs(wo.z()));
        if (u.x() >= share) {
            const float x = std::min((u.x() - share) / (1 - share), kOneMinusEpsilon);
            *wi = SampleCosine(wo, {x, u.y()}, false);
            return true;
        }
        const Vec3f h = distribution.SampleVisibleNormal(wo, {u.x() / share, u.y()});
        *wi = (2 * wo.dot(h)) * h - wo;
        return SameHemisphere(wo, *wi);
    }

    // Returns the share of light to a cosine that comes from the base, but for "scale".
    Rgb BaseAlbedo(float cosO) const {
        return Series() * (Through(cosO) * Blend(&CoatRow::escaping));
    }
    // Returns about how much the coat reflects.
    float CoatAlbedo(float cosO) const { return FresnelDielectric(cosO, row->eta); }

  private:
    float Blend(float CoatRow::*member) const {
        return blend == 0 ? row[0].*member : (1 - blend) * row[0].*member + blend * row[1].*member;
    }
    float Through(float cosine) const {
        const float first = row->Through(cosine);
        return blend == 0 ? first : (1 - blend) * first + blend * row[1].Through(cosine);
    }
    // Returns the albedo times the series of light that comes back to the base.
    Rgb Series() const {
        const Rgb rho = base, again = rho * Blend(&CoatRow::returned);
        return rho * (1 + again * (1 + again * (1 + again * (1 + again))));
    }
    float CoatShare(float cosO) const {
        const float coat = CoatAlbedo(cosO), below = BaseAlbedo(cosO).sum() / 3;
        return std::clamp(coat / (coat + below), 0.1f, 0.9f);
    }
};

// A smooth conductor under a smooth coat, which reflects into the direction of a mirror.
struct CoatedConductorInterface {
    float eta, thickness;  // of the coat
    StoredRgb n, k;        // of the conductor relative to the coat

    Rgb operator()(float cosine) const;
};

// A conductor under a coat of which one at least is rough. There is no closed form: f is the mean
// of a few walks whose random numbers come from the directions.
struct CoatedConductorLobe {
    static constexpr bool kIsSpecular = false, kTransmits = false;
    StoredRgb n, k;                       // of the conductor relative to the coat
    float eta, thickness;                 // of the coat
    uint16_t coatAlpha[2], baseAlpha[2];  // in units of 1 / kAlphaUnits; 0: smooth
    StoredRgb scale = Rgb(1, 1, 1);

    static constexpr float kAlphaUnits = 40'000;
    static uint16_t StoreAlpha(float alpha);

    BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi) const;
    bool Sample(const Vec3f& wo, const Vec2f& u, Vec3f* wi) const;
};

// A sheet of glass that is too thin to displace light: light goes to and fro in it.
struct ThinDielectricLobe {
    static constexpr bool kIsSpecular = true, kTransmits = true;
    StoredRgb r;
    float eta;

    // Returns the share that both sides reflect, together.
    float Reflectance(float cosO) const {
        const float once = FresnelDielectric(std::abs(cosO), eta);
        return once < 1 ? 2 * once / (1 + once) : 1;
    }
    bool Sample(const Vec3f& wo, const Vec2f& u, SpecularSample* s) const {
        const float reflectance = Reflectance(wo.z());
        const Rgb f = Rgb(r) / std::abs(wo.z());
        if (u.x() < reflectance)
            *s = {f * reflectance, reflectance, {-wo.x(), -wo.y(), wo.z()}, false};
        else
            *s = {f * (1 - reflectance), 1 - reflectance, -wo, true};
        return true;
    }
};

}  // namespace lull
