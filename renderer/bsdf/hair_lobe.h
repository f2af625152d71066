// The scattering of a hair (Marschner et al. 2003; d'Eon et al. 2011; Chiang et al. 2016, as
// pbrt-v3 has it). See lobes.h for the interface.
#pragma once

#include "renderer/bsdf/microfacet.h"

namespace lull {

// Sums the light that a dielectric, absorbing cylinder reflects, and the light that leaves it after
// one passage, after two, and after more. The hair runs along x of the local frame. f is divided by
// |cos wi|, which cancels the cosine that it is multiplied by when used.
struct HairLobe {
    static constexpr bool kIsSpecular = false, kTransmits = false, kIsTwoSided = true;
    StoredRgb r;          // scales f
    StoredRgb sigmaA;     // absorption for a radius of 1
    float h;              // offset of the point across the hair, in [-1, 1]
    float eta;            // index of refraction
    float variance;       // along the hair, of the reflection
    float logisticScale;  // around the hair
    float sinTilt;        // of the scales on its surface

    // `betaM` and `betaN` are the roughness along and around the hair, clamped to [0.01, 1]: at 0,
    // which pbrt-v3 admits, its formulas become 0 / 0. `alpha` is the tilt in degrees.
    HairLobe(const Rgb& sigmaA, float h, float eta, float betaM, float betaN, float alpha);

    BsdfValue Evaluate(const Vec3f& wo, const Vec3f& wi) const;
    bool Sample(const Vec3f& wo, const Vec2f& u, Vec3f* wi) const;
};

// Return the absorption due to concentrations of eumelanin and pheomelanin, and the absorption with
// which hair of azimuthal roughness betaN appears in the colour c, each in (0, 1].
Rgb HairAbsorption(float eumelanin, float pheomelanin);
Rgb HairAbsorptionOfColor(const Rgb& c, float betaN);

}  // namespace lull
