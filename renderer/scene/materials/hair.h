// Represents hair and fur, on shapes whose u runs along the hair and v across it.
#pragma once

#include "renderer/scene/materials/material_inputs.h"

namespace lull {

struct Hair {
    static constexpr const char* kName = "hair";

    // The first of these that is given says how much light the hair absorbs.
    std::optional<SpectrumTexture> sigmaA, color;
    FloatTexture eumelanin, pheomelanin;
    FloatTexture eta, betaM, betaN, alpha;

    explicit Hair(const MaterialReader& in);
    std::string Problem(const MaterialReader& in) const { return ProblemOfIndex(in, eta); }

    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;

    // The offset across the hair is a texture coordinate, so hair is never constant.
    template <typename F>
    void VisitTextures(F&& f) const {
        for (const auto* t : {&sigmaA, &color})
            if (*t) f(**t);
        for (const FloatTexture* t : {&eumelanin, &pheomelanin, &eta, &betaM, &betaN, &alpha})
            f(*t);
    }
    bool NeedsTangents() const { return true; }
    bool NeedsUv() const { return true; }
    int MaxLobes() const { return 1; }
};

}  // namespace lull
