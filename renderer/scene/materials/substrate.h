// Represents a diffuse base under a glossy coat, which receives what the coat does not reflect.
#pragma once

#include "renderer/scene/materials/roughness.h"

namespace lull {

struct Substrate {
    static constexpr const char* kName = "substrate";

    SpectrumTexture kd, ks;
    Roughness roughness;

    explicit Substrate(const MaterialReader& in);

    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;

    template <typename F>
    void VisitTextures(F&& f) const {
        f(kd);
        f(ks);
        roughness.VisitTextures(f);
    }
    int MaxLobes() const { return 1; }
};

}  // namespace lull
