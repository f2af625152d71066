// Estimates the fraction of uniform light that a lobe scatters to wo (z != 0), see AlbedoOf().
#pragma once

#include "renderer/base/math.h"
#include "renderer/bsdf/layered_lobes.h"
#include "renderer/bsdf/lobes.h"

namespace lull {

// Makes the estimate as a Value: float, its luminance, or Rgb.
template <typename Value>
class LobeAlbedo {
  public:
    explicit LobeAlbedo(const Vec3f& wo) : wo(wo), cosO(std::abs(wo.z())) {}

    // The diffuse part of FresnelBlend scatters all light that the glossy part does not, except for
    // a loss at grazing angles.
    Value OfDiffuse(const FresnelBlend& lobe) const {
        const float v = 1 - 0.5f * cosO;
        return To(Rgb(lobe.scale) * Rgb(lobe.rd) * (1 - Rgb(lobe.rs))) * (1 - Sqr(Sqr(v)) * v);
    }
    Value OfGlossy(const FresnelBlend& lobe) const {
        return To(Rgb(lobe.scale) * FresnelSchlick(lobe.rs, cosO));
    }

    template <typename L>
    Value operator()(const L& lobe) const {
        if constexpr (requires { lobe.interface; })
            return To(Rgb(lobe.r) * lobe.interface(wo.z()));
        else if constexpr (requires { lobe.r; })
            return To(lobe.r);
        else
            return To(lobe.t);
    }
    Value operator()(const MicrofacetTransmission& lobe) const { return OfTransmission(lobe); }
    Value operator()(const DisneyTransmission& lobe) const { return OfTransmission(lobe); }
    Value operator()(const SpecularTransmission& lobe) const { return OfTransmission(lobe); }
    // Retro-reflection and sheen are only seen at grazing angles.
    Value operator()(const DisneyDiffuse& lobe) const {
        const bool isGrazing = lobe.part == DisneyDiffuse::Part::RetroReflection ||
                               lobe.part == DisneyDiffuse::Part::Sheen;
        return (isGrazing ? 0.2f : 1.f) * To(lobe.r);
    }
    Value operator()(const CharlieSheen& lobe) const {
        return To(lobe.r) * SheenAlbedo(cosO, lobe.alpha);
    }
    Value operator()(const DisneyClearcoat& lobe) const {
        return To(lobe.r) * 0.25f * (0.04f + 0.96f * SchlickWeight(cosO));
    }
    Value operator()(const FresnelSpecular& lobe) const {
        const float reflectance = FresnelDielectric(wo.z(), lobe.eta);
        return (1 - reflectance) * To(lobe.t) + reflectance * To(lobe.r);
    }
    Value operator()(const FresnelBlend& lobe) const { return OfDiffuse(lobe) + OfGlossy(lobe); }
    Value operator()(const LayeredReflection& lobe) const {
        const InterfaceAbove above = lobe.stored;
        const GgxAlbedo albedo = DirectionalAlbedo(cosO, lobe.alpha);
        const Rgb base = Rgb(lobe.diffuse) * std::max(0.f, 1 - albedo(above.f0, above.f90));
        const Rgb interface = Rgb(lobe.f0) * albedo.ofF0 + lobe.f90 * albedo.ofF90;
        return To(Rgb(lobe.scale) * (base + interface)) * lobe.coat.Through(cosO);
    }
    Value operator()(const ThinTransmission& lobe) const {
        return To(lobe.t) * (std::max(0.f, lobe.above.Through(cosO)) * lobe.coat.Through(cosO));
    }
    Value operator()(const ThinSpecular& lobe) const {
        const InterfaceAbove above = lobe.stored;
        const Rgb f0 = lobe.f0, reflected = f0 + SchlickWeight(cosO) * (lobe.f90 - f0);
        const Rgb through = Rgb(lobe.t) * std::max(0.f, above.Through(cosO));
        return To(Rgb(lobe.scale) * (reflected + through)) * lobe.coat.Through(cosO);
    }
    Value operator()(const CoatedDiffuseLobe& lobe) const {
        const float coat = lobe.row->isSmooth ? 0 : lobe.CoatAlbedo(cosO);
        return To(Rgb(lobe.scale) * (lobe.BaseAlbedo(cosO) + coat));
    }
    Value operator()(const CoatedConductorLobe& lobe) const {
        const CoatedConductorInterface smooth{lobe.eta, lobe.thickness, lobe.n, lobe.k};
        return To(Rgb(lobe.scale) * smooth(wo.z()));
    }

  private:
    static Value To(const Rgb& c) {
        if constexpr (std::is_same_v<Value, float>)
            return Luminance(c);
        else
            return c;
    }
    Value OfTransmission(const auto& lobe) const {
        return To(lobe.t) * (1 - FresnelDielectric(wo.z(), lobe.eta));
    }

    Vec3f wo;
    float cosO;
};

}  // namespace lull
