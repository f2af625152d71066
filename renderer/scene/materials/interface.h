// Represents no surface, only the boundary of two media: "none". Paths go straight through.
#pragma once

#include "renderer/scene/materials/material_inputs.h"

namespace lull {

struct Interface {
    explicit Interface(const MaterialReader&) {}

    MaterialTraits Traits(const MaterialReader&) const { return {.needs = kIsInterface}; }
    // A bump map has nothing to tilt.
    SurfaceTilt Tilt(const MaterialReader& in) const { return in.BumpMap(), SurfaceTilt(); }
    void AddLobes(const MaterialInputs&, Bsdf*) const {}
};

}  // namespace lull
