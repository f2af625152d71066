// Represents Disney's principled material (Burley 2012 and 2015), less scattering beneath the
// surface.
#pragma once

#include "renderer/scene/materials/material_inputs.h"

namespace lull {

struct Disney {
    static constexpr const char* kName = "disney";

    SpectrumTexture color, scatterDistance;
    FloatTexture metallic, eta, rough, specularTint, anisotropic, sheen, sheenTint, clearcoat,
        clearcoatGloss, specTrans;
    bool thin;
    FloatTexture flatness, diffTrans;  // of thin surfaces

    explicit Disney(const MaterialReader& in);

    // Returns what is not modelled of it, "" where all is.
    std::string Problem(const MaterialReader&) const {
        return IsAlwaysBlack(scatterDistance)
                   ? ""
                   : "\"scatterdistance\" of a disney material is not modelled";
    }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;

    template <typename F>
    void VisitTextures(F&& f) const {
        f(color);
        for (const FloatTexture* t :
             {&metallic, &eta, &rough, &specularTint, &anisotropic, &sheen, &sheenTint, &clearcoat,
              &clearcoatGloss, &specTrans, &flatness, &diffTrans})
            f(*t);
    }
    bool NeedsTangents() const { return !(anisotropic.IsConstant() && anisotropic.constant == 0); }
    int MaxLobes() const;
};

}  // namespace lull
