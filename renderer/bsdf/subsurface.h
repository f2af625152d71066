// Models light that enters a translucent solid and leaves it elsewhere, as pbrt-v3 does: by
// tabulated photon beam diffusion (Habel, Christensen, Jarosz 2013; pbrt 3rd ed., 15.5) or by two
// exponentials (Burley 2015).
#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "renderer/base/math.h"
#include "renderer/base/variant.h"
#include "renderer/bsdf/microfacet.h"

namespace lull {

// Tabulates the profile of a semi-infinite solid under a beam along the normal, over the
// single-scattering albedo and the distance in mean free paths (sigma_t = 1).
struct DiffusionTable {
    static constexpr int kAlbedos = 100, kRadii = 64;

    std::array<float, kAlbedos> albedo;
    std::array<float, kRadii> radius;
    std::array<float, kAlbedos> effectiveAlbedo;  // the integral of each albedo's profile
    // Rows of kRadii: the profile times 2 pi r, and its integral from 0 to each radius.
    std::vector<float> profile, cdf;

    // `g` in (-1, 1) is the mean cosine of scattering, `eta` >= 1 the index of the solid.
    DiffusionTable(float g, float eta);
};

class DiffusionProfile {
  public:
    // `sigmaA`, `sigmaS` >= 0 are the coefficients of absorption and scattering, 1/length. The
    // table must outlive the profile.
    DiffusionProfile(const DiffusionTable& table, const Rgb& sigmaA, const Rgb& sigmaS);

    // Returns the light that leaves at distance r from where it entered, 1/area.
    Rgb operator()(float r) const;

    // Chooses a distance for a channel; nothing if that does not scatter. Pdf is the density over
    // area, for all directions together.
    std::optional<float> Sample(int channel, float u) const;
    float Pdf(int channel, float r) const;

  private:
    const DiffusionTable* table;
    Rgb sigmaT, albedo;
};

// Represents the profile that Burley 2015, "Extending the Disney BRDF to a BSDF with Integrated
// Subsurface Scattering", fits to measured and simulated ones.
class BurleyProfile {
  public:
    // `albedo` is the integral of the profile, `distance` >= 0 the mean free path, both 1 per
    // channel; a channel whose distance is 0 scatters nothing.
    BurleyProfile(const Rgb& albedo, const Rgb& distance)
        : albedo(albedo), distance(0.2f * distance) {}

    Rgb operator()(float r) const;
    std::optional<float> Sample(int channel, float u) const;
    float Pdf(int channel, float r) const;

  private:
    Rgb albedo, distance;
};

class SubsurfaceProfile {
  public:
    SubsurfaceProfile(const DiffusionProfile& profile, float eta) : eta(eta), kind(profile) {}
    SubsurfaceProfile(const BurleyProfile& profile, float eta) : eta(eta), kind(profile) {}

    Rgb operator()(float r) const {
        return Visit(kind, [&](const auto& k) { return k(r); });
    }
    // Chooses a distance for a channel; nothing where it scatters nothing.
    std::optional<float> Sample(int channel, float u) const {
        return Visit(kind, [&](const auto& k) { return k.Sample(channel, u); });
    }
    // Returns the density over area, for all directions together, with which Sample chooses r.
    float Pdf(int channel, float r) const {
        return Visit(kind, [&](const auto& k) { return k.Pdf(channel, r); });
    }

    float eta;  // index of the solid

  private:
    std::variant<DiffusionProfile, BurleyProfile> kind;
};

// Returns the single-scattering albedo, in [0, 1], for which a solid has the albedo `effective`
// under uniform light, or the nearest possible.
float AlbedoOfScattering(const DiffusionTable& table, float effective);

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

// Finds absorption and reduced scattering, 1/mm, of a material of Jensen et al. 2001 or Narasimhan
// et al. 2006 by its name in pbrt-v3. Returns false, and leaves both unchanged, for other names.
bool FindMediumPreset(const std::string& name, Rgb* sigmaA, Rgb* sigmaS);

// Models how a medium scatters light (Henyey and Greenstein 1941).

// Returns the density of scattering, 1/sr, between the direction that light comes from and the one
// it goes to, both pointing away; `cosine` is that of the angle between them. g in (-1, 1) is the
// mean cosine of the deflection: positive for forward scattering.
inline float PhaseHenyeyGreenstein(float cosine, float g) {
    const float q = std::max(1 + Sqr(g) + 2 * g * cosine, 1e-12f);
    return (1 - Sqr(g)) / (4 * kPi * q * std::sqrt(q));
}

// Chooses wi with that density, for wo unit.
inline Vec3f SampleHenyeyGreenstein(const Vec3f& wo, float g, const Vec2f& u) {
    float cosine = 1 - 2 * u.x();
    if (std::abs(g) >= 1e-3f) {
        const float root = (1 - Sqr(g)) / (1 + g - 2 * g * u.x());
        cosine = std::clamp(-(1 + Sqr(g) - Sqr(root)) / (2 * g), -1.f, 1.f);
    }
    const float sine = SafeSqrt(1 - Sqr(cosine)), phi = 2 * kPi * u.y();
    Vec3f s, t;
    CoordinateSystem(wo, &s, &t);
    return (sine * std::cos(phi) * s + sine * std::sin(phi) * t + cosine * wo).normalized();
}

}  // namespace lull
