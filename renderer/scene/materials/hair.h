// Represents hair and fur, on shapes whose u runs along the hair and v across it.
#pragma once

#include "renderer/scene/materials/material_inputs.h"

namespace lull {

struct Hair {
    // The first of these that is given says how much light the hair absorbs.
    std::optional<SpectrumTexture> sigmaA, color;
    FloatTexture eumelanin, pheomelanin;
    FloatTexture eta, betaM, betaN, alpha;

    explicit Hair(const MaterialReader& in);
    std::string Problem(const MaterialReader& in) const { return ProblemOfIndex(in, eta); }

    MaterialTraits Traits(const MaterialReader& in) const;
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

}  // namespace lull
