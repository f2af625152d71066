#include "renderer/bsdf/lobes.h"

#include "renderer/base/color.h"

namespace lull {
namespace {

template <typename L>
void Scale(L* lobe, const Rgb& s) {
    if constexpr (requires { lobe->scale; }) {
        lobe->scale *= s;
    } else {
        if constexpr (requires { lobe->r; }) lobe->r *= s;
        if constexpr (requires { lobe->t; }) lobe->t *= s;
    }
}
void Scale(std::monostate*, const Rgb&) {}

// The diffuse part of FresnelBlend is made so that it gives all that the glossy one leaves, but for
// what is lost at grazing angles.
float DiffuseAlbedo(const FresnelBlend& lobe, float cosO) {
    const float v = 1 - 0.5f * cosO;
    return Luminance(Rgb(lobe.scale) * Rgb(lobe.rd) * (1 - Rgb(lobe.rs))) * (1 - Sqr(Sqr(v)) * v);
}
float GlossyAlbedo(const FresnelBlend& lobe, float cosO) {
    return Luminance(Rgb(lobe.scale) * FresnelSchlick(lobe.rs, cosO));
}

template <typename L>
float Albedo(const L& lobe, const Vec3f& wo) {
    if constexpr (requires { lobe.interface; })
        return Luminance(Rgb(lobe.r) * lobe.interface(wo.z()));
    else if constexpr (requires { lobe.r; })
        return Luminance(lobe.r);
    else
        return Luminance(lobe.t);
}
float TransmissionAlbedo(const StoredRgb& t, float eta, const Vec3f& wo) {
    return Luminance(t) * (1 - FresnelDielectric(wo.z(), eta));
}
float Albedo(const MicrofacetTransmission& lobe, const Vec3f& wo) {
    return TransmissionAlbedo(lobe.t, lobe.eta, wo);
}
float Albedo(const DisneyTransmission& lobe, const Vec3f& wo) {
    return TransmissionAlbedo(lobe.t, lobe.eta, wo);
}
// Retro-reflection and sheen are only seen at grazing angles.
float Albedo(const DisneyDiffuse& lobe, const Vec3f&) {
    const bool isGrazing = lobe.part == DisneyDiffuse::Part::RetroReflection ||
                           lobe.part == DisneyDiffuse::Part::Sheen;
    return (isGrazing ? 0.2f : 1.f) * Luminance(lobe.r);
}
float Albedo(const DisneyClearcoat& lobe, const Vec3f& wo) {
    return Luminance(lobe.r) * 0.25f * (0.04f + 0.96f * SchlickWeight(std::abs(wo.z())));
}
float Albedo(const SpecularTransmission& lobe, const Vec3f& wo) {
    return TransmissionAlbedo(lobe.t, lobe.eta, wo);
}
float Albedo(const FresnelSpecular& lobe, const Vec3f& wo) {
    return Lerp(FresnelDielectric(wo.z(), lobe.eta), Luminance(lobe.t), Luminance(lobe.r));
}
float Albedo(const FresnelBlend& lobe, const Vec3f& wo) {
    return DiffuseAlbedo(lobe, std::abs(wo.z())) + GlossyAlbedo(lobe, std::abs(wo.z()));
}

float Albedo(const LayeredReflection& lobe, const Vec3f& wo) {
    const float cosO = std::abs(wo.z());
    const InterfaceAbove above = lobe.stored;
    const GgxAlbedo albedo = DirectionalAlbedo(cosO, lobe.alpha);
    const Rgb base = Rgb(lobe.diffuse) * std::max(0.f, 1 - albedo(above.f0, above.f90));
    const Rgb interface = Rgb(lobe.f0) * albedo.ofF0 + lobe.f90 * albedo.ofF90;
    return Luminance(Rgb(lobe.scale) * (base + interface)) * ThroughCoat(lobe.coat, cosO, 1);
}
float Albedo(const ThinTransmission& lobe, const Vec3f& wo) {
    return Luminance(lobe.t) * std::max(0.f, lobe.above.Through(std::abs(wo.z())));
}
float Albedo(const ThinSpecular& lobe, const Vec3f& wo) {
    const float cosO = std::abs(wo.z());
    const InterfaceAbove above = lobe.stored;
    const Rgb f0 = lobe.f0, reflected = f0 + SchlickWeight(cosO) * (lobe.f90 - f0);
    const Rgb through = Rgb(lobe.t) * std::max(0.f, above.Through(cosO));
    return Luminance(Rgb(lobe.scale) * (reflected + through));
}

}  // namespace

Lobe Scaled(const Lobe& lobe, const Rgb& scale) {
    Lobe scaled = lobe;
    std::visit([&](auto& l) { Scale(&l, scale); }, scaled);
    return scaled;
}

float EstimatedAlbedo(const Lobe& lobe, const Vec3f& wo) {
    return VisitLobe(lobe, [&](const auto& l) { return Albedo(l, wo); });
}

void ChoosePartsByShare(const Vec3f& wo, float least, Lobe* lobe) {
    FresnelBlend* blend = std::get_if<FresnelBlend>(lobe);
    if (!blend) return;
    const float cosO = std::abs(wo.z());
    const float diffuse = DiffuseAlbedo(*blend, cosO), glossy = GlossyAlbedo(*blend, cosO);
    const float share = glossy / (diffuse + glossy);
    if (share >= 0) blend->glossyShare = std::clamp(share, least, 1 - least);
}

}  // namespace lull
