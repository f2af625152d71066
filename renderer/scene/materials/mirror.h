// Represents a perfect mirror.
#pragma once

#include "renderer/scene/materials/material_inputs.h"

namespace lull {

struct Mirror {
    static constexpr const char* kName = "mirror";

    SpectrumTexture kr;

    explicit Mirror(const MaterialReader& in) : kr(in.Spectrum("Kr", 0.9f)) {}

    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;

    template <typename F>
    void VisitTextures(F&& f) const {
        f(kr);
    }
    int MaxLobes() const { return 1; }
};

}  // namespace lull
