// Represents a diffuse surface.
#pragma once

#include "renderer/scene/materials/material_inputs.h"

namespace lull {

struct Matte {
    SpectrumTexture kd;
    FloatTexture sigma;  // degrees, clamped to [0, 90]; 0: Lambertian, else Oren-Nayar

    explicit Matte(const MaterialReader& in)
        : kd(in.Spectrum("Kd", 0.5f)), sigma(in.Float("sigma", 0)) {}

    MaterialTraits Traits(const MaterialReader& in) const { return in.TraitsOf(1, kd, sigma); }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

}  // namespace lull
