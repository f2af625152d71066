// Holds what all kinds of material share: how they read their parameters, and their inputs at a hit
// point.
//
// A kind is a struct K with
//     static constexpr const char* kName                 as in scene files;
//     explicit K(const MaterialReader&)                  reads the parameters;
//     void AddLobes(const MaterialInputs&, Bsdf*) const  adds the lobes, sets eta if not 1;
//     void VisitTextures(f) const                        calls f with every texture it evaluates;
//     int MaxLobes() const                               how many lobes AddLobes can add,
// and, where they apply,
//     SurfaceNeeds ExtraNeeds() const                    what it reads of a hit besides its
//     textures;
//     std::string Problem(const MaterialReader&) const   what is wrong or not modelled, "" if
//     nothing; bool NeedsTangents() const, bool NeedsUv() const   whether the lobes depend on
//     these; bool VariesWithHit() const   whether they differ from hit to hit where no texture
//     does.
#pragma once

#include <optional>
#include <span>

#include "renderer/bsdf/bsdf.h"
#include "renderer/scene/interaction.h"
#include "renderer/scene/texture.h"

namespace lull {

struct Material;

// Reads the parameters of one material. `made` are the materials before it.
struct MaterialReader {
    const MaterialEntity& entity;
    const TextureTable& textures;
    std::span<const Material> made;
    const Description& description;  // relative file names start at its directory

    FloatTexture Float(const std::string& name, float otherwise) const {
        return textures.GetFloat(entity, name, otherwise);
    }
    SpectrumTexture Spectrum(const std::string& name, float otherwise) const {
        return textures.GetSpectrum(entity, name, Rgb::Constant(otherwise));
    }
    std::optional<FloatTexture> FloatOrNone(const std::string& name) const {
        return textures.GetFloatOrNone(entity, name);
    }
    // Reads an index of refraction: "eta", or "index", its older name; 1.5 by default.
    FloatTexture IndexOfRefraction() const {
        const std::optional<FloatTexture> eta = FloatOrNone("eta");
        return eta ? *eta : Float("index", 1.5f);
    }
};

// Says whether a number can be an index of refraction. Light that goes in and out of what is beyond
// these, and is not all reflected, would count up to 1e4 times.
inline bool IsIndexOfRefraction(float index) { return index >= 0.01f && index <= 100; }

// Says what is wrong with an index of refraction that is the same everywhere, "" if nothing.
std::string ProblemOfIndex(const MaterialReader&, const FloatTexture& index);

// Holds what lobes are made from at a hit point. `materials` is the whole table, for mixtures.
// `hit` is null if a material without ExtraNeeds is turned into lobes once and for all.
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

// Says whether a colour is known to be black everywhere, so that its lobe never appears.
inline bool IsAlwaysBlack(const SpectrumTexture& t) {
    return t.IsConstant() && (t.constant <= 0).all();
}

// Adds the lobes of the operand-th material of the table, without its bump map. In material.cpp,
// the only file that knows every kind.
void AddOperandLobes(int operand, const MaterialInputs&, Bsdf*);

}  // namespace lull
