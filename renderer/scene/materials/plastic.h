// Represents a diffuse surface under a glossy coat.
#pragma once

#include "renderer/scene/materials/roughness.h"

namespace lull {

struct Plastic {
    static constexpr const char* kName = "plastic";

    SpectrumTexture kd, ks;
    Roughness roughness;

    explicit Plastic(const MaterialReader& in);

    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;

    template <typename F>
    void VisitTextures(F&& f) const {
        f(kd);
        f(ks);
        roughness.VisitTextures(f);
    }
    int MaxLobes() const { return !IsAlwaysBlack(kd) + !IsAlwaysBlack(ks); }
};

}  // namespace lull
