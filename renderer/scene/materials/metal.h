// Represents a rough conductor.
#pragma once

#include "renderer/scene/materials/roughness.h"

namespace lull {

struct Metal {
    static constexpr const char* kName = "metal";

    SpectrumTexture eta, k;  // complex index of refraction; copper's by default
    Roughness roughness;

    explicit Metal(const MaterialReader& in);

    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;

    template <typename F>
    void VisitTextures(F&& f) const {
        f(eta);
        f(k);
        roughness.VisitTextures(f);
    }
    int MaxLobes() const { return 1; }
};

}  // namespace lull
