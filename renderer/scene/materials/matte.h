// Represents a diffuse surface.
#pragma once

#include "renderer/scene/materials/material_inputs.h"

namespace lull {

struct Matte {
    static constexpr const char* kName = "matte";

    SpectrumTexture kd;
    FloatTexture sigma;  // degrees, clamped to [0, 90]; 0: Lambertian, else Oren-Nayar

    explicit Matte(const MaterialReader& in)
        : kd(in.Spectrum("Kd", 0.5f)), sigma(in.Float("sigma", 0)) {}

    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;

    template <typename F>
    void VisitTextures(F&& f) const {
        f(kd);
        f(sigma);
    }
    int MaxLobes() const { return 1; }
};

}  // namespace lull
