// A diffuse base under a glossy coat, which receives the light that the coat does not reflect.
#pragma once

#include "renderer/scene/materials/roughness.h"

namespace lull {

struct Substrate {
    SpectrumTexture kd, ks;
    Roughness roughness;

    explicit Substrate(const MaterialReader& in);

    MaterialTraits Traits(const MaterialReader& in) const {
        return in.TraitsOf(1, kd, ks, roughness);
    }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

}  // namespace lull
