#include "renderer/bsdf/lobes.h"

#include "renderer/bsdf/lobe_albedo_internal.h"

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

}  // namespace

Lobe Scaled(const Lobe& lobe, const Rgb& scale) {
    Lobe scaled = lobe;
    Visit(scaled, [&](auto& l) { Scale(&l, scale); });
    return scaled;
}

float EstimatedAlbedo(const Lobe& lobe, const Vec3f& wo) {
    return VisitLobe(lobe, [&](const auto& l) { return Albedo(l, wo, ToLuminance{}); });
}

void ChoosePartsByShare(const Vec3f& wo, float least, Lobe* lobe) {
    FresnelBlend* blend = std::get_if<FresnelBlend>(lobe);
    if (!blend) return;
    const float cosO = std::abs(wo.z());
    const float diffuse = DiffuseAlbedo(*blend, cosO, ToLuminance{});
    const float glossy = GlossyAlbedo(*blend, cosO, ToLuminance{});
    const float share = glossy / (diffuse + glossy);
    if (share >= 0) blend->glossyShare = std::clamp(share, least, 1 - least);
}

}  // namespace lull
