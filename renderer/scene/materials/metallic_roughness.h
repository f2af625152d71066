// Represents glTF 2.0's material (appendix B of its specification) with the extensions
// KHR_materials_ior, _specular, _transmission, _volume (its refraction, not its absorption) and
// _clearcoat.
#pragma once

#include "renderer/scene/materials/material_inputs.h"

namespace lull {

// Holds a texture that may be looked up with the second set of texture coordinates.
template <typename Texture>
struct UvSlot {
    Texture texture;
    bool secondUv = false;
};

// Reads the following textures, each multiplied by the parameter NAMEfactor, and looked up with the
// second texture coordinates if NAMEuv is 1: "basecolor"; "metallicroughness" (roughness in green,
// metallic in blue; the factors are "metallicfactor" and "roughnessfactor"); "specular",
// "specularcolor", "transmission", "clearcoat", "clearcoatroughness". Also "ior"; "solid":
// transmitted light is refracted, otherwise the surface is a thin sheet; "vertexcolors": the mesh's
// colours multiply the base colour.
struct MetallicRoughness {
    static constexpr const char* kName = "metallicroughness";

    UvSlot<SpectrumTexture> baseColor, metallicRoughness, specularColor;
    UvSlot<FloatTexture> specular, transmission, clearcoat, clearcoatRoughness;
    Rgb baseColorFactor, specularColorFactor;
    float metallicFactor, roughnessFactor, specularFactor, transmissionFactor, clearcoatFactor,
        clearcoatRoughnessFactor;
    float ior;
    bool solid, vertexColors;

    explicit MetallicRoughness(const MaterialReader& in);

    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;

    // Returns what it reads of a hit besides its textures' needs.
    SurfaceNeeds ExtraNeeds() const;

    template <typename F>
    void VisitTextures(F&& f) const {
        for (const auto* slot : {&baseColor, &metallicRoughness, &specularColor}) f(slot->texture);
        for (const auto* slot : {&specular, &transmission, &clearcoat, &clearcoatRoughness})
            f(slot->texture);
    }
    int MaxLobes() const { return 4; }
};

}  // namespace lull
