// Represents a thin sheet that scatters light to both sides, diffusely and glossily.
#pragma once

#include "renderer/scene/materials/roughness.h"

namespace lull {

struct Translucent {
    static constexpr const char* kName = "translucent";

    SpectrumTexture kd, ks, reflect, transmit;
    Roughness roughness;

    explicit Translucent(const MaterialReader& in);

    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;

    template <typename F>
    void VisitTextures(F&& f) const {
        for (const SpectrumTexture* t : {&kd, &ks, &reflect, &transmit}) f(*t);
        roughness.VisitTextures(f);
    }
    int MaxLobes() const {
        return (!IsAlwaysBlack(kd) + !IsAlwaysBlack(ks)) *
               (!IsAlwaysBlack(reflect) + !IsAlwaysBlack(transmit));
    }
};

}  // namespace lull
