// Represents glTF 2.0's material (appendix B of its specification) with the extensions
// KHR_materials_ior, _specular, _transmission, _volume (its absorption is a medium of the shape),
// _clearcoat, _sheen, _anisotropy and _diffuse_transmission.
#pragma once

#include "renderer/scene/materials/material_inputs.h"

namespace lull {

// A texture, its factor, and whether it is looked up with the second set of texture coordinates.
template <typename Texture, typename Factor = float>
struct UvSlot {
    Texture texture;
    bool secondUv = false;
    Factor factor;
};

// Reads the following textures, each multiplied by the parameter NAMEfactor, and looked up with the
// second texture coordinates if NAMEuv is 1: "basecolor"; "metallicroughness" (roughness in green,
// metallic in blue; the factors are "metallicfactor" and "roughnessfactor"); "specular",
// "specularcolor", "transmission", "clearcoat", "clearcoatroughness", "sheencolor",
// "sheenroughness", "anisotropy" (the factor is its strength in [0, 1]; red and green are a
// direction along the tangents, blue a strength), "diffusetransmission" (the fraction of the
// diffuse base that scatters to the other side) and "diffusetransmissioncolor". Also "ior";
// "solid": transmitted light is refracted, otherwise the surface is a thin sheet; "vertexcolors":
// the mesh's colours multiply the base colour; "anisotropyrotation": radians, from the first
// tangent to the second; "addedinterface": interface and coat are added to the base, which they do
// not attenuate and which is Disney's, as in the Principled BSDF of Blender 3 (not
// energy-conserving), with its Fresnel and separable masking; "eveninterface": it reflects as much
// from all directions, over a Lambertian base that it does not attenuate; "keepsradiance": solids
// do not scale the radiance that they refract by the square of the index, as if it left them again.
struct MetallicRoughness {
    UvSlot<SpectrumTexture, Rgb> baseColor, specularColor, sheenColor, diffuseTransmissionColor;
    UvSlot<SpectrumTexture> metallicRoughness, anisotropy;  // the former's factors are apart
    UvSlot<FloatTexture> specular, transmission, clearcoat, clearcoatRoughness, sheenRoughness,
        diffuseTransmission;
    float metallicFactor, roughnessFactor, ior, anisotropyRotation;
    bool solid, vertexColors, addedInterface, evenInterface, keepsRadiance;

    explicit MetallicRoughness(const MaterialReader& in);

    MaterialTraits Traits(const MaterialReader& in) const;
    void AddLobes(const MaterialInputs& in, Bsdf* bsdf) const;
    // Reads "normalmap", with "normalscale" and "normaluv" (1: the second texture coordinates).
    SurfaceTilt Tilt(const MaterialReader& in) const;

  private:
    // Returns whether it is a smooth thin sheet anywhere, which light goes straight through.
    bool CanLetThrough() const;
    bool IsCoatedSolid() const { return solid && transmission.factor > 0 && clearcoat.factor > 0; }
    template <typename F>
    void VisitSlots(F&& f) const {
        for (const auto* slot :
             {&baseColor, &specularColor, &sheenColor, &diffuseTransmissionColor})
            f(*slot);
        for (const auto* slot : {&metallicRoughness, &anisotropy}) f(*slot);
        for (const auto* slot : {&specular, &transmission, &clearcoat, &clearcoatRoughness,
                                 &sheenRoughness, &diffuseTransmission})
            f(*slot);
    }
    // Returns the roughness along the tangents for `alpha`, and turns the frame where anisotropic.
    Vec2f Alphas(const MaterialInputs& in, float alpha, Bsdf* bsdf) const;
    // Adds the interface that reflects from f0 to f90 and attenuates nothing.
    void AddOwnInterface(const Rgb& f0, float f90, float eta, bool isSmooth, const Vec2f& alphas,
                         Bsdf* bsdf) const;
    // Adds sheen over all lobes that there are, below a coat.
    void AddSheen(const MaterialInputs& in, const CoatAbove& coat, Bsdf* bsdf) const;
    // Adds the `share` of the base's light that leaves on the other side, below an interface.
    void AddDiffuseTransmission(const MaterialInputs& in, float share, const InterfaceAbove& above,
                                float alpha, const CoatAbove& coat, Bsdf* bsdf) const;
    void AddClearcoat(float coat, float alpha, Bsdf* bsdf) const;
    // Adds the interface of a solid that reflects and transmits so much.
    void AddSolid(const MaterialInputs& in, const Rgb& reflected, Rgb through, bool isSmooth,
                  const Vec2f& alphas, Bsdf* bsdf) const;
};

}  // namespace lull
