// Represents pbrt's kitchen sink: diffuse, glossy, mirror and glass parts under one opacity.
#pragma once

#include "renderer/scene/materials/roughness.h"

namespace lull {

struct Uber {
    SpectrumTexture kd, ks, kr, kt, opacity;
    FloatTexture eta;  // index of refraction
    Roughness roughness;

    explicit Uber(const MaterialReader& in);
    std::string Problem(const MaterialReader& in) const { return ProblemOfIndex(in, eta); }

    MaterialTraits Traits(const MaterialReader& in) const;
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

}  // namespace lull
