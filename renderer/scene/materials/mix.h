// Represents a weighted sum of two other materials.
#pragma once

#include "renderer/scene/materials/material_inputs.h"

namespace lull {

struct Mix {
    SpectrumTexture amount;       // of the first; the second gets 1 - amount
    std::array<int, 2> operands;  // into the table, before this one

    explicit Mix(const MaterialReader& in);

    // A material can only be named after it was made, so there are no cycles.
    std::string Problem(const MaterialReader& in) const;

    MaterialTraits Traits(const MaterialReader& in) const;
    // pbrt-v3 shades a mix in the frame of the first material, so its tilt counts.
    SurfaceTilt Tilt(const MaterialReader& in) const { return TiltOfOperand(operands[0], in.made); }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

}  // namespace lull
