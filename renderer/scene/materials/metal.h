// Represents a rough conductor.
#pragma once

#include "renderer/scene/materials/roughness.h"

namespace lull {

struct Metal {
    SpectrumTexture eta, k;  // complex index of refraction; copper's by default
    Roughness roughness;

    explicit Metal(const MaterialReader& in);

    MaterialTraits Traits(const MaterialReader& in) const {
        return in.TraitsOf(1, eta, k, roughness);
    }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

}  // namespace lull
