// Represents a thin sheet that scatters light to both sides, diffusely and glossily.
#pragma once

#include "renderer/scene/materials/roughness.h"

namespace lull {

struct Translucent {
    SpectrumTexture kd, ks, reflect, transmit;
    Roughness roughness;

    explicit Translucent(const MaterialReader& in);

    MaterialTraits Traits(const MaterialReader& in) const {
        const int most = (!IsAlwaysBlack(kd) + !IsAlwaysBlack(ks)) *
                         (!IsAlwaysBlack(reflect) + !IsAlwaysBlack(transmit));
        return in.TraitsOf(most, kd, ks, reflect, transmit, roughness);
    }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

}  // namespace lull
