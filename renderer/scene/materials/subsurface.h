// Represents translucent solids that light enters through a dielectric surface and leaves
// elsewhere, given by their coefficients ("subsurface") or their appearance ("kdsubsurface").
#pragma once

#include <string>

#include "renderer/base/error.h"
#include "renderer/base/math.h"
#include "renderer/bsdf/subsurface.h"
#include "renderer/scene/materials/basic.h"

namespace lull {

// Absorption and scattering. Those that were measured are reduced: the mean cosine is 0.
struct MediumPreset {
    Rgb sigmaA, sigmaS;
    bool isMeasured = false;
};

// Returns the coefficients of that name; pbrt-v3's default for "" and, with a warning, for names
// that no table has.
MediumPreset ReadMediumPreset(const std::string& name, const FileLoc& loc, Warnings& warnings);

// The surface of both kinds, below which transmitted light continues.
struct TranslucentSolid {
    SpectrumTexture kr, kt;
    Roughness roughness;
    float eta, g, scale;
    std::shared_ptr<const DiffusionTable> table;

    explicit TranslucentSolid(const MaterialReader& in, float g);

    std::string Problem(const MaterialReader&) const;
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;

  protected:
    // Returns the traits of a solid that depends on these textures as well.
    template <typename... Textures>
    MaterialTraits SolidTraits(const MaterialReader& in, const Textures&... read) const {
        const int most = !IsAlwaysBlack(kr) + !IsAlwaysBlack(kt);
        MaterialTraits traits = in.TraitsOf(most, kr, kt, roughness, read...);
        traits.Need(kScattersBelow | kNeedsTangents);
        return traits;
    }
};

// Parameters: coefficients of absorption and scattering, 1/length times "scale", or a "name".
struct Subsurface : TranslucentSolid {
    SpectrumTexture sigmaA, sigmaS;

    explicit Subsurface(const MaterialReader& in);
    Subsurface(const MaterialReader& in, const MediumPreset& preset);

    MaterialTraits Traits(const MaterialReader& in) const {
        return SolidTraits(in, sigmaA, sigmaS);
    }
    std::optional<SubsurfaceProfile> Profile(const MaterialInputs& in) const;
};

// Parameters: the albedo under uniform light, and the mean free path times "scale".
struct KdSubsurface : TranslucentSolid {
    SpectrumTexture kd, meanFreePath;

    explicit KdSubsurface(const MaterialReader& in);

    MaterialTraits Traits(const MaterialReader& in) const {
        return SolidTraits(in, kd, meanFreePath);
    }
    std::optional<SubsurfaceProfile> Profile(const MaterialInputs& in) const;
};

}  // namespace lull
