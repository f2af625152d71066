// Represents Disney's principled material (Burley 2012 and 2015).
#pragma once

#include "renderer/bsdf/subsurface.h"
#include "renderer/scene/materials/material_inputs.h"

namespace lull {

struct Disney {
    SpectrumTexture color, scatterDistance;
    FloatTexture metallic, eta, rough, specularTint, anisotropic, sheen, sheenTint, clearcoat,
        clearcoatGloss, specTrans;
    bool thin;
    FloatTexture flatness, diffTrans;  // of thin surfaces

    explicit Disney(const MaterialReader& in);
    std::string Problem(const MaterialReader& in) const { return ProblemOfIndex(in, eta); }

    MaterialTraits Traits(const MaterialReader& in) const;
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
    // Returns nothing if the diffuse part does not scatter below the surface.
    std::optional<SubsurfaceProfile> Profile(const MaterialInputs& in) const;
};

}  // namespace lull
