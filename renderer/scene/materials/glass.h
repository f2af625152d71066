// Represents a dielectric, smooth or rough.
#pragma once

#include "renderer/scene/materials/roughness.h"

namespace lull {

struct Glass {
    static constexpr const char* kName = "glass";

    SpectrumTexture kr, kt;
    FloatTexture eta;     // index of refraction
    Roughness roughness;  // 0 both ways: smooth

    explicit Glass(const MaterialReader& in);
    std::string Problem(const MaterialReader& in) const { return ProblemOfIndex(in, eta); }

    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;

    template <typename F>
    void VisitTextures(F&& f) const {
        f(kr);
        f(kt);
        f(eta);
        roughness.VisitTextures(f);
    }
    int MaxLobes() const { return !IsAlwaysBlack(kr) + !IsAlwaysBlack(kt); }
};

// Adds the lobes of a dielectric of index `eta`, smooth or rough, and sets the index.
void AddDielectricLobes(const Rgb& reflected, const Rgb& transmitted, float eta, const Roughness&,
                        const MaterialInputs&, Bsdf*);

}  // namespace lull
