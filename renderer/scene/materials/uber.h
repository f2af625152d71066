// Represents pbrt's kitchen sink: diffuse, glossy, mirror and glass parts under one opacity.
#pragma once

#include "renderer/scene/materials/roughness.h"

namespace lull {

struct Uber {
    static constexpr const char* kName = "uber";

    SpectrumTexture kd, ks, kr, kt, opacity;
    FloatTexture eta;  // index of refraction
    Roughness roughness;

    explicit Uber(const MaterialReader& in);
    std::string Problem(const MaterialReader& in) const { return ProblemOfIndex(in, eta); }

    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;

    template <typename F>
    void VisitTextures(F&& f) const {
        for (const SpectrumTexture* t : {&kd, &ks, &kr, &kt, &opacity}) f(*t);
        f(eta);
        roughness.VisitTextures(f);
    }
    int MaxLobes() const;
};

}  // namespace lull
