// The interface of materials, and code that all kinds share.
//
// A kind is a struct K, in a file of this folder, with
//
//     explicit K(const MaterialReader&)
//         reads the parameters;
//     MaterialTraits Traits(const MaterialReader&) const
//         returns the inputs of its lobes, and their maximum number;
//     void AddLobes(const MaterialInputs&, Bsdf*) const
//         adds the lobes at a hit, and sets eta where that is not 1,
//
// and, where they apply,
//
//     std::string Problem(const MaterialReader&) const
//         returns the invalid or unsupported parameters as a message, "" if none;
//     std::optional<SubsurfaceProfile> Profile(const MaterialInputs&) const
//         returns how light that the lobes transmit spreads below the surface; nothing where it
//         continues unscattered. The needs have kScattersBelow;
//     SurfaceTilt Tilt(const MaterialReader&) const
//         reads the maps of the shading normal, unless only "bumpmap" is used.
#pragma once

#include <optional>
#include <span>

#include "renderer/bsdf/bsdf.h"
#include "renderer/scene/interaction.h"
#include "renderer/scene/textures/texture.h"

namespace lull {

// Tilts the shading geometry as a displacement of the surface would.
//
// Turns hit->ns, dpdu and dpdv to those of the surface displaced by the texture along its shading
// normal, which stays on the side of hit->n (Blinn 1978, with the displacement's own term, as
// pbrt-v3). Differences are taken over the step pbrt-v3 uses where it has no ray differentials,
// 0.0005 in u and v. If the result has no normal, the hit stays unchanged.
void ApplyBumpMap(const FloatTexture& displacement, const TextureTable&, SurfaceInteraction* hit);

// Tilts shading normals by an image of normals.
//
// Normals in the frame of the surface's tangents, each coordinate from -1 to 1 stored as 0 to
// 1: x along u, y along v, which grows upwards in the image (glTF 2.0, 3.9.3).
struct NormalMap {
    SpectrumTexture texture;
    float scale = 1;        // of x and y
    bool secondUv = false;  // which texture coordinates it is looked up with
};

// Turns hit->ns, and the tangents with it, as the map says. The hit needs tangents. It stays
// unchanged if the result has no direction or points below the surface.
void ApplyNormalMap(const NormalMap&, const TextureTable&, SurfaceInteraction* hit);

struct Material;

// Properties of a material that are independent of the hit.
struct MaterialTraits {
    SurfaceNeeds needs = kNeedsNothing;  // of a hit, for the lobes
    int mostLobes = 0;                   // that AddLobes can add
    bool isConstant = true;              // the lobes are the same at all hits

    // Takes into account that the lobes depend on this part of a hit.
    void Need(SurfaceNeeds part) {
        needs = needs | part;
        isConstant = false;
    }
};

// Maps of the shading normals of a material.
struct SurfaceTilt {
    std::optional<FloatTexture> bump{};
    std::optional<NormalMap> normalMap{};
};

// Reads the parameters of a material; knows the textures and, in `made`, the materials before it.
struct MaterialReader {
    const MaterialEntity& entity;
    const TextureTable& textures;
    std::span<const Material> made;
    const Description& description;  // relative file names start at its directory
    Warnings& warnings;

    FloatTexture Float(const std::string& name, float otherwise) const {
        return textures.GetFloat(entity, name, otherwise);
    }
    SpectrumTexture Spectrum(const std::string& name, float otherwise) const {
        return textures.GetSpectrum(entity, name, Rgb::Constant(otherwise));
    }
    // Read shares of light, from 0 to 1. Warn of constants outside, which count as in pbrt-v3.
    SpectrumTexture ShareOfColors(const std::string& name, float otherwise) const;
    FloatTexture Share(const std::string& name, float otherwise) const;
    std::optional<FloatTexture> FloatOrNone(const std::string& name) const {
        return textures.GetFloatOrNone(entity, name);
    }
    // Reads an index of refraction: "eta", or "index", its older name; 1.5 by default.
    FloatTexture IndexOfRefraction() const {
        const std::optional<FloatTexture> eta = FloatOrNone("eta");
        return eta ? *eta : Float("index", 1.5f);
    }
    // Reads "bumpmap", and "normals", pbrt-v4's normal map; nothing where both are flat.
    SurfaceTilt BumpMap() const;

    // Returns the traits of up to `mostLobes` lobes that depend on textures alone.
    template <typename... Textures>
    MaterialTraits TraitsOf(int mostLobes, const Textures&... read) const {
        MaterialTraits traits{.mostLobes = mostLobes};
        (AddTexture(read, &traits), ...);
        return traits;
    }

  private:
    template <typename T>
    void AddTexture(const TextureHandle<T>& texture, MaterialTraits* traits) const {
        if (!texture.IsConstant()) traits->Need(textures.Needs(texture));
    }
    template <typename T>
    void AddTexture(const std::optional<T>& texture, MaterialTraits* traits) const {
        if (texture) AddTexture(*texture, traits);
    }
    template <typename Roughness>
    void AddTexture(const Roughness& roughness, MaterialTraits* traits) const {
        roughness.VisitTextures([&](const auto& t) { AddTexture(t, traits); });
        if (!roughness.IsIsotropic()) traits->needs = traits->needs | kNeedsTangents;
    }
};

// Reads a colour; nothing where it is not given.
std::optional<SpectrumTexture> SpectrumOrNone(const MaterialReader& in, const char* name);

// Returns whether a number can be an index of refraction. Beyond these limits, light that enters
// and leaves without total reflection would count up to 1e4 times.
inline bool IsIndexOfRefraction(float index) { return index >= 0.01f && index <= 100; }

// Returns the error of a constant index of refraction as a message, "" if none.
std::string ProblemOfIndex(const MaterialReader&, const FloatTexture& index);

// Inputs of lobes at a hit point. `materials` is the whole table, for mixtures.
// `hit` is null if the lobes of a constant material are made once and for all.
struct MaterialInputs {
    const TextureTable& textures;
    TextureContext context;
    std::span<const Material> materials;
    const SurfaceInteraction* hit = nullptr;

    float operator()(const FloatTexture& t) const { return textures.Evaluate(t, context); }
    // Textures may give any colour; for scattering negative values count as 0.
    Rgb Color(const SpectrumTexture& t) const { return Raw(t).max(0.f); }
    Rgb Raw(const SpectrumTexture& t) const { return textures.Evaluate(t, context); }
    // Where a texture has no index of refraction, there is nothing to refract at.
    float Index(const FloatTexture& t) const {
        const float index = (*this)(t);
        return IsIndexOfRefraction(index) ? index : 1;
    }
};

// Returns whether a colour is known to be black everywhere, so that its lobe never appears.
inline bool IsAlwaysBlack(const SpectrumTexture& t) {
    return t.IsConstant() && (t.constant <= 0).all();
}

// How a roughness becomes alpha: not at all, as in pbrt-v3, or by its root, as in pbrt-v4.
enum class Remapping { None, PbrtV3, Root };

// The roughness along one tangent; a constant is turned into alpha once.
class RoughnessAxis {
  public:
    RoughnessAxis(const FloatTexture& texture, Remapping remapping)
        : texture(texture), remapping(remapping) {
        if (!texture.IsConstant()) return;
        constantIsZero = texture.constant == 0;
        this->texture.constant = ToAlpha(texture.constant);
    }

    // Returns alpha; `isZero` tells whether the roughness itself was 0.
    float Alpha(const MaterialInputs& in, bool* isZero) const {
        if (texture.IsConstant()) {
            *isZero = constantIsZero;
            return texture.constant;
        }
        const float roughness = in(texture);
        *isZero = roughness == 0;
        return ToAlpha(roughness);
    }
    const FloatTexture& Texture() const { return texture; }

  private:
    float ToAlpha(float roughness) const {
        if (remapping == Remapping::PbrtV3) return RoughnessToAlpha(roughness);
        return remapping == Remapping::Root ? SafeSqrt(roughness) : roughness;
    }

    FloatTexture texture;  // a constant holds alpha
    Remapping remapping;
    bool constantIsZero = false;
};

// The roughness of a surface along both tangents. "remaproughness" (true) says whether the
// parameters are pbrt-v3's perceptual roughness or alpha itself, and "remapping", of scenes for
// pbrt-v4, that alpha is its "sqrt", or "none".
class Roughness {
  public:
    Roughness(const MaterialReader& in, const FloatTexture& u, const FloatTexture& v)
        : Roughness(u, v, RemappingOf(in.entity.parameters)) {}
    Roughness(const FloatTexture& u, const FloatTexture& v, Remapping remapping)
        : u(u, remapping), v(v, remapping) {
        isIsotropic = u.index == v.index && (!u.IsConstant() || u.constant == v.constant);
    }

    // `isSmooth`, if given, receives whether both were 0, which some materials take as specular.
    TrowbridgeReitz Evaluate(const MaterialInputs& in, bool* isSmooth = nullptr) const {
        bool uIsZero, vIsZero;
        const float alphaU = u.Alpha(in, &uIsZero);
        if (isIsotropic) {
            if (isSmooth) *isSmooth = uIsZero;
            return {alphaU, alphaU};
        }
        const float alphaV = v.Alpha(in, &vIsZero);
        if (isSmooth) *isSmooth = uIsZero && vIsZero;
        return {alphaU, alphaV};
    }

    // Returns whether both tangents always have the same roughness, so that any frame will do.
    bool IsIsotropic() const { return isIsotropic; }

    template <typename F>
    void VisitTextures(F&& f) const {
        f(u.Texture());
        f(v.Texture());
    }

  private:
    static Remapping RemappingOf(const Parameters& parameters) {
        const std::string remapping = parameters.GetString("remapping", "");
        if (remapping == "sqrt") return Remapping::Root;
        if (remapping == "none") return Remapping::None;
        return parameters.GetBool("remaproughness", true) ? Remapping::PbrtV3 : Remapping::None;
    }

    RoughnessAxis u, v;
    bool isIsotropic;
};

}  // namespace lull
