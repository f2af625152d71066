// Represents a perfect mirror.
#pragma once

#include "renderer/scene/materials/material_inputs.h"

namespace lull {

struct Mirror {
    SpectrumTexture kr;

    explicit Mirror(const MaterialReader& in) : kr(in.Spectrum("Kr", 0.9f)) {}

    MaterialTraits Traits(const MaterialReader& in) const { return in.TraitsOf(1, kr); }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

}  // namespace lull
