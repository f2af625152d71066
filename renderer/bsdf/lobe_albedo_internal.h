// Estimates the fraction of uniform light that a lobe scatters to wo (z != 0), ignoring roughness.
// See EstimatedAlbedo() and AlbedoOf().
#pragma once

#include "renderer/base/color.h"
#include "renderer/bsdf/directional_albedo.h"
#include "renderer/bsdf/lobes.h"

namespace lull {

// The value of a colour in the estimates below: its luminance, or the colour itself.
struct ToLuminance {
    using Value = float;
    float operator()(const Rgb& c) const { return Luminance(c); }
};
struct ToColor {
    using Value = Rgb;
    Rgb operator()(const Rgb& c) const { return c; }
};

// The diffuse part of FresnelBlend scatters all light that the glossy part does not, except for a
// loss at grazing angles.
template <typename To>
typename To::Value DiffuseAlbedo(const FresnelBlend& lobe, float cosO, To to) {
    const float v = 1 - 0.5f * cosO;
    return to(Rgb(lobe.scale) * Rgb(lobe.rd) * (1 - Rgb(lobe.rs))) * (1 - Sqr(Sqr(v)) * v);
}
template <typename To>
typename To::Value GlossyAlbedo(const FresnelBlend& lobe, float cosO, To to) {
    return to(Rgb(lobe.scale) * FresnelSchlick(lobe.rs, cosO));
}

template <typename L, typename To>
typename To::Value Albedo(const L& lobe, const Vec3f& wo, To to) {
    if constexpr (requires { lobe.interface; })
        return to(Rgb(lobe.r) * lobe.interface(wo.z()));
    else if constexpr (requires { lobe.r; })
        return to(lobe.r);
    else
        return to(lobe.t);
}
template <typename To>
typename To::Value TransmissionAlbedo(const StoredRgb& t, float eta, const Vec3f& wo, To to) {
    return to(t) * (1 - FresnelDielectric(wo.z(), eta));
}
template <typename To>
typename To::Value Albedo(const MicrofacetTransmission& lobe, const Vec3f& wo, To to) {
    return TransmissionAlbedo(lobe.t, lobe.eta, wo, to);
}
template <typename To>
typename To::Value Albedo(const DisneyTransmission& lobe, const Vec3f& wo, To to) {
    return TransmissionAlbedo(lobe.t, lobe.eta, wo, to);
}
// Retro-reflection and sheen are only seen at grazing angles.
template <typename To>
typename To::Value Albedo(const DisneyDiffuse& lobe, const Vec3f&, To to) {
    const bool isGrazing = lobe.part == DisneyDiffuse::Part::RetroReflection ||
                           lobe.part == DisneyDiffuse::Part::Sheen;
    return (isGrazing ? 0.2f : 1.f) * to(lobe.r);
}
template <typename To>
typename To::Value Albedo(const CharlieSheen& lobe, const Vec3f& wo, To to) {
    return to(lobe.r) * SheenAlbedo(std::abs(wo.z()), lobe.alpha);
}
template <typename To>
typename To::Value Albedo(const DisneyClearcoat& lobe, const Vec3f& wo, To to) {
    return to(lobe.r) * 0.25f * (0.04f + 0.96f * SchlickWeight(std::abs(wo.z())));
}
template <typename To>
typename To::Value Albedo(const SpecularTransmission& lobe, const Vec3f& wo, To to) {
    return TransmissionAlbedo(lobe.t, lobe.eta, wo, to);
}
template <typename To>
typename To::Value Albedo(const FresnelSpecular& lobe, const Vec3f& wo, To to) {
    const float reflectance = FresnelDielectric(wo.z(), lobe.eta);
    return (1 - reflectance) * to(lobe.t) + reflectance * to(lobe.r);
}
template <typename To>
typename To::Value Albedo(const FresnelBlend& lobe, const Vec3f& wo, To to) {
    return DiffuseAlbedo(lobe, std::abs(wo.z()), to) + GlossyAlbedo(lobe, std::abs(wo.z()), to);
}
template <typename To>
typename To::Value Albedo(const LayeredReflection& lobe, const Vec3f& wo, To to) {
    const float cosO = std::abs(wo.z());
    const InterfaceAbove above = lobe.stored;
    const GgxAlbedo albedo = DirectionalAlbedo(cosO, lobe.alpha);
    const Rgb base = Rgb(lobe.diffuse) * std::max(0.f, 1 - albedo(above.f0, above.f90));
    const Rgb interface = Rgb(lobe.f0) * albedo.ofF0 + lobe.f90 * albedo.ofF90;
    return to(Rgb(lobe.scale) * (base + interface)) * lobe.coat.Through(cosO);
}
template <typename To>
typename To::Value Albedo(const ThinTransmission& lobe, const Vec3f& wo, To to) {
    return to(lobe.t) * (std::max(0.f, lobe.above.Through(std::abs(wo.z()))) *
                         lobe.coat.Through(std::abs(wo.z())));
}
template <typename To>
typename To::Value Albedo(const ThinSpecular& lobe, const Vec3f& wo, To to) {
    const float cosO = std::abs(wo.z());
    const InterfaceAbove above = lobe.stored;
    const Rgb f0 = lobe.f0, reflected = f0 + SchlickWeight(cosO) * (lobe.f90 - f0);
    const Rgb through = Rgb(lobe.t) * std::max(0.f, above.Through(cosO));
    return to(Rgb(lobe.scale) * (reflected + through)) * lobe.coat.Through(cosO);
}
template <typename To>
typename To::Value Albedo(const CoatedDiffuseLobe& lobe, const Vec3f& wo, To to) {
    const float cosO = std::abs(wo.z());
    const float coat = lobe.row->isSmooth ? 0 : lobe.CoatAlbedo(cosO);
    return to(Rgb(lobe.scale) * (lobe.BaseAlbedo(cosO) + coat));
}
template <typename To>
typename To::Value Albedo(const CoatedConductorLobe& lobe, const Vec3f& wo, To to) {
    const CoatedConductorInterface smooth{lobe.eta, lobe.thickness, lobe.n, lobe.k};
    return to(Rgb(lobe.scale) * smooth(wo.z()));
}

}  // namespace lull
