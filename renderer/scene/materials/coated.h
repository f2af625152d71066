// Materials of pbrt-v4 that are layered: a diffuse base or a conductor under a dielectric coat, and
// thin sheets of glass.
#pragma once

#include <memory>

#include "renderer/scene/materials/material_inputs.h"

namespace lull {

// Parameters: "reflectance", "eta" and "thickness" of the coat, "uroughness", "vroughness".
struct CoatedDiffuse {
    SpectrumTexture reflectance;
    Roughness roughness;
    float eta;
    std::shared_ptr<const CoatTable> table;

    explicit CoatedDiffuse(const MaterialReader& in);
    std::string Problem(const MaterialReader& in) const {
        return ProblemOfIndex(in, FloatTexture{eta});
    }
    MaterialTraits Traits(const MaterialReader& in) const {
        return in.TraitsOf(2, reflectance, roughness);
    }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

// Parameters: "interface.eta", "interface.uroughness", "interface.vroughness" and "thickness" of
// the coat; "eta" and "k", or "reflectance", "conductor.uroughness" and "conductor.vroughness" of
// the conductor.
struct CoatedConductor {
    SpectrumTexture eta, k;
    std::optional<SpectrumTexture> reflectance;
    Roughness coat, base;
    float index, thickness;

    explicit CoatedConductor(const MaterialReader& in);
    std::string Problem(const MaterialReader& in) const {
        return ProblemOfIndex(in, FloatTexture{index});
    }
    MaterialTraits Traits(const MaterialReader& in) const {
        return in.TraitsOf(2, eta, k, reflectance, coat, base);
    }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

// Parameter: "eta".
struct ThinDielectric {
    FloatTexture eta;

    explicit ThinDielectric(const MaterialReader& in) : eta(in.IndexOfRefraction()) {}
    std::string Problem(const MaterialReader& in) const { return ProblemOfIndex(in, eta); }
    MaterialTraits Traits(const MaterialReader& in) const { return in.TraitsOf(1, eta); }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
        bsdf->Add(ThinDielectricLobe{Rgb(1, 1, 1), in.Index(eta)});
    }
};

}  // namespace lull
