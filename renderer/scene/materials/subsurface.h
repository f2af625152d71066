// Represents translucent solids that light enters through a dielectric surface and leaves
// elsewhere, given by their coefficients ("subsurface") or their appearance ("kdsubsurface").
#pragma once

#include "renderer/scene/diffusion_profile.h"
#include "renderer/scene/materials/glass.h"

namespace lull {

// Holds what both kinds share: the surface, below which transmitted light continues.
struct TranslucentSolid {
    SpectrumTexture kr, kt;
    Roughness roughness;
    float eta, g, scale;
    std::shared_ptr<const DiffusionTable> table;

    explicit TranslucentSolid(const MaterialReader& in, float g);

    SurfaceNeeds ExtraNeeds() const { return kScattersBelow | kNeedsTangents; }
    std::string Problem(const MaterialReader&) const;
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
    int MaxLobes() const { return !IsAlwaysBlack(kr) + !IsAlwaysBlack(kt); }
    template <typename F>
    void VisitTextures(F&& f) const {
        f(kr);
        f(kt);
        roughness.VisitTextures(f);
    }
};

// Is given coefficients of absorption and scattering, 1/length times "scale", or those of a "name".
struct Subsurface : TranslucentSolid {
    static constexpr const char* kName = "subsurface";

    SpectrumTexture sigmaA, sigmaS;

    explicit Subsurface(const MaterialReader& in);

    SubsurfaceProfile Profile(const MaterialInputs& in) const;
    template <typename F>
    void VisitTextures(F&& f) const {
        TranslucentSolid::VisitTextures(f);
        f(sigmaA);
        f(sigmaS);
    }
};

// Is given the albedo that it shows under uniform light, and the mean free path times "scale".
struct KdSubsurface : TranslucentSolid {
    static constexpr const char* kName = "kdsubsurface";

    SpectrumTexture kd, meanFreePath;

    explicit KdSubsurface(const MaterialReader& in);

    SubsurfaceProfile Profile(const MaterialInputs& in) const;
    template <typename F>
    void VisitTextures(F&& f) const {
        TranslucentSolid::VisitTextures(f);
        f(kd);
        f(meanFreePath);
    }
};

}  // namespace lull
