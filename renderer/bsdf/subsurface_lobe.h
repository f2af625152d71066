// The lobe by which light leaves a translucent solid.
#pragma once

#include "renderer/bsdf/lobe_basics.h"

namespace lull {

// Transmits the part of light from all sides that a smooth dielectric does not reflect: the
// directional part of a separable BSSRDF (pbrt 3rd ed., eq. 11.8).
struct DiffuseExit {
    static constexpr bool kIsSpecular = false, kTransmits = false;
    StoredRgb r;
    float eta;  // index of the solid

    BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi) const {
        return {Rgb(r) * ((1 - FresnelDielectric(wi.z(), eta)) * kInvPi),
                SameHemisphere(wo, wi) ? std::abs(wi.z()) * kInvPi : 0};
    }
    bool Sample(const Vec3f& wo, const Vec2f& u, Vec3f* wi) const {
        *wi = SampleCosine(wo, u, false);
        return true;
    }
};

}  // namespace lull
