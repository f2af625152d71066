// The lobe of cloth whose fibres stand out of it (KHR_materials_sheen). See lobes.h for the
// interface.
#pragma once

#include "renderer/bsdf/microfacet.h"

namespace lull {

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
