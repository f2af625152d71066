// Shared code of lobes: their values, and comparison and sampling of directions.
#pragma once

#include "renderer/base/sampling.h"
#include "renderer/bsdf/fresnel.h"
#include "renderer/bsdf/microfacet.h"

namespace lull {

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

}  // namespace lull
