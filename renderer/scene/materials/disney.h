// Represents Disney's principled material (Burley 2012 and 2015).
#pragma once

#include "renderer/scene/diffusion_profile.h"
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
    std::string Problem(const MaterialReader& in) const { return ProblemOfIndex(in, eta); }

    SurfaceNeeds ExtraNeeds() const {
        return thin || IsAlwaysBlack(scatterDistance) ? kNeedsNothing
                                                      : kScattersBelow | kNeedsTangents;
    }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
    // Returns nothing if the diffuse part does not scatter below the surface.
    std::optional<SubsurfaceProfile> Profile(const MaterialInputs& in) const;

    template <typename F>
    void VisitTextures(F&& f) const {
        f(color);
        f(scatterDistance);
        for (const FloatTexture* t :
             {&metallic, &eta, &rough, &specularTint, &anisotropic, &sheen, &sheenTint, &clearcoat,
              &clearcoatGloss, &specTrans, &flatness, &diffTrans})
            f(*t);
    }
    bool NeedsTangents() const { return !(anisotropic.IsConstant() && anisotropic.constant == 0); }
    int MaxLobes() const;
};

}  // namespace lull
