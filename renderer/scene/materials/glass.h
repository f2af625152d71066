// Represents a dielectric, smooth or rough.
#pragma once

#include "renderer/scene/materials/roughness.h"

namespace lull {

struct Glass {
    SpectrumTexture kr, kt;
    FloatTexture eta;     // index of refraction
    Roughness roughness;  // 0 both ways: smooth

    explicit Glass(const MaterialReader& in);
    std::string Problem(const MaterialReader& in) const { return ProblemOfIndex(in, eta); }

    MaterialTraits Traits(const MaterialReader& in) const {
        return in.TraitsOf(!IsAlwaysBlack(kr) + !IsAlwaysBlack(kt), kr, kt, eta, roughness);
    }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

// Adds the lobes of a dielectric of index `eta`, smooth or rough, and sets the index.
void AddDielectricLobes(const Rgb& reflected, const Rgb& transmitted, float eta, const Roughness&,
                        const MaterialInputs&, Bsdf*);

}  // namespace lull
