// Materials that are textures and a few lobes: pbrt-v3's and pbrt-v4's.
#pragma once

#include <memory>
#include <string>

#include "renderer/bsdf/subsurface.h"
#include "renderer/scene/materials/material_inputs.h"

namespace lull {

// Represents no surface, only the boundary of two media: "none". Paths go straight through.
struct Interface {
    explicit Interface(const MaterialReader&) {}

    MaterialTraits Traits(const MaterialReader&) const { return {.needs = kIsInterface}; }
    // A bump map has nothing to tilt.
    SurfaceTilt Tilt(const MaterialReader& in) const { return in.BumpMap(), SurfaceTilt(); }
    void AddLobes(const MaterialInputs&, Bsdf*) const {}
};

struct Matte {
    SpectrumTexture kd;
    FloatTexture sigma;  // degrees, clamped to [0, 90]; 0: Lambertian, else Oren-Nayar

    explicit Matte(const MaterialReader& in)
        : kd(in.ShareOfColors("Kd", 0.5f)), sigma(in.Float("sigma", 0)) {}

    MaterialTraits Traits(const MaterialReader& in) const { return in.TraitsOf(1, kd, sigma); }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

struct Mirror {
    SpectrumTexture kr;

    explicit Mirror(const MaterialReader& in) : kr(in.ShareOfColors("Kr", 0.9f)) {}

    MaterialTraits Traits(const MaterialReader& in) const { return in.TraitsOf(1, kr); }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

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

// Adds the lobes of a dielectric of index `eta`, smooth or rough.
void AddDielectricLobes(const Rgb& reflected, const Rgb& transmitted, float eta, bool isSmooth,
                        const TrowbridgeReitz&, Bsdf*);
// Adds them, unless both colours are black, and sets the index.
void AddDielectric(const Rgb& reflected, const Rgb& transmitted, float eta, const Roughness&,
                   const MaterialInputs&, Bsdf*);

struct Metal {
    SpectrumTexture eta, k;                      // complex index of refraction; copper's by default
    std::optional<SpectrumTexture> reflectance;  // head-on, instead
    Roughness roughness;
    bool mirrors;  // where the roughness is 0, as in pbrt-v4; else there is always some

    explicit Metal(const MaterialReader& in);

    MaterialTraits Traits(const MaterialReader& in) const {
        return in.TraitsOf(1, eta, k, reflectance, roughness);
    }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

// Returns k of the conductor of index 1 + i k that reflects so much head-on, as pbrt-v4 has it.
Rgb AbsorptionOf(const Rgb& reflectance);

struct Plastic {
    SpectrumTexture kd, ks;
    Roughness roughness;

    explicit Plastic(const MaterialReader& in);

    MaterialTraits Traits(const MaterialReader& in) const {
        return in.TraitsOf(!IsAlwaysBlack(kd) + !IsAlwaysBlack(ks), kd, ks, roughness);
    }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

// A diffuse base under a glossy coat, which receives the light that the coat does not reflect.
struct Substrate {
    SpectrumTexture kd, ks;
    Roughness roughness;

    explicit Substrate(const MaterialReader& in);

    MaterialTraits Traits(const MaterialReader& in) const {
        return in.TraitsOf(1, kd, ks, roughness);
    }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

// Represents a thin sheet that scatters light to both sides, diffusely and glossily.
struct Translucent {
    SpectrumTexture kd, ks, reflect, transmit;
    Roughness roughness;

    explicit Translucent(const MaterialReader& in);

    MaterialTraits Traits(const MaterialReader& in) const {
        const int most = (!IsAlwaysBlack(kd) + !IsAlwaysBlack(ks)) *
                         (!IsAlwaysBlack(reflect) + !IsAlwaysBlack(transmit));
        return in.TraitsOf(most, kd, ks, reflect, transmit, roughness);
    }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

// Represents pbrt's kitchen sink: diffuse, glossy, mirror and glass parts under one opacity.
struct Uber {
    SpectrumTexture kd, ks, kr, kt, opacity;
    FloatTexture eta;  // index of refraction
    Roughness roughness;

    explicit Uber(const MaterialReader& in);
    std::string Problem(const MaterialReader& in) const { return ProblemOfIndex(in, eta); }

    MaterialTraits Traits(const MaterialReader& in) const;
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

// Represents Disney's principled material (Burley 2012 and 2015).
struct Disney {
    SpectrumTexture color, scatterDistance;
    FloatTexture metallic, eta, rough, specularTint, anisotropic, sheen, sheenTint, clearcoat,
        clearcoatGloss, specTrans;
    bool thin;
    FloatTexture flatness, diffTrans;  // of thin surfaces

    explicit Disney(const MaterialReader& in);
    std::string Problem(const MaterialReader& in) const { return ProblemOfIndex(in, eta); }

    MaterialTraits Traits(const MaterialReader& in) const;
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
    // Returns nothing if the diffuse part does not scatter below the surface.
    std::optional<SubsurfaceProfile> Profile(const MaterialInputs& in) const;
};

// Represents hair and fur, on shapes whose u runs along the hair and v across it.
struct Hair {
    // The first of these that is given says how much light the hair absorbs.
    std::optional<SpectrumTexture> sigmaA, color;
    FloatTexture eumelanin, pheomelanin;
    FloatTexture eta, betaM, betaN, alpha;

    explicit Hair(const MaterialReader& in);
    std::string Problem(const MaterialReader& in) const { return ProblemOfIndex(in, eta); }

    MaterialTraits Traits(const MaterialReader& in) const;
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

// Layered materials of pbrt-v4: a diffuse base or a conductor under a dielectric coat; thin glass.

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

// Reads the .bsdf files of layered materials: version 1 of the format, as layerlab writes it and
// pbrt-v3 reads it: one basis, without textures and extrapolation, one channel or three. Throws
// Error with the path if it is anything else, cut short, or holds impossible numbers.
FourierTable LoadFourierTable(const std::string& path);

// Represents a layered or measured material, tabulated in a file.
struct Fourier {
    std::shared_ptr<const FourierTable> table;
    std::string problem;  // why there is no table

    explicit Fourier(const MaterialReader& in);

    // Returns why the file could not be read, "" if it was.
    std::string Problem(const MaterialReader&) const { return problem; }
    MaterialTraits Traits(const MaterialReader& in) const { return in.TraitsOf(1); }
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
};

}  // namespace lull
