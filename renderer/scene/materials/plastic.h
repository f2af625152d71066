// Represents a diffuse surface under a glossy coat.
#pragma once

#include "renderer/scene/materials/roughness.h"

namespace lull {

struct Plastic {
    SpectrumTexture kd, ks;
    Roughness roughness;

    explicit Plastic(const MaterialReader& in);

    MaterialTraits Traits(const MaterialReader& in) const {
        return in.TraitsOf(!IsAlwaysBlack(kd) + !IsAlwaysBlack(ks), kd, ks, roughness);
    }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

}  // namespace lull
