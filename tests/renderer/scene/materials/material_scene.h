// Builds descriptions of materials and textures for tests, and looks into the Bsdfs made of them.
#pragma once

#include <gtest/gtest.h>

#include "renderer/scene/materials/material.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/scene/parameters.h"

namespace lull::test {

using DielectricReflection = MicrofacetReflection<DielectricInterface>;
using ConductorReflection = MicrofacetReflection<ConductorInterface>;

inline Parameter Textured(const std::string& name, int texture, bool isSpectrum) {
    TextureRef ref{"checks"};
    (isSpectrum ? ref.spectrumIndex : ref.floatIndex) = texture;
    return {ParameterType::Texture, name, LocAt(3), std::vector<TextureRef>{ref}};
}

// Builds descriptions of materials and textures.
struct MaterialScene {
    Description description;
    std::vector<std::string> messages;
    Warnings warnings;

    explicit MaterialScene(bool substitutes = false)
        : warnings([this](const std::string& m) { messages.push_back(m); }, substitutes) {}

    MaterialEntity& AddMaterial(const std::string& kind,
                                const std::vector<Parameter>& parameters = {}) {
        MaterialEntity& m = description.materials.emplace_back();
        m.name = kind;
        m.loc = LocAt(10 * int(description.materials.size()));
        for (const Parameter& parameter : parameters) m.parameters.Add(parameter);
        return m;
    }
    // Adds a 3D checkerboard of 0 and `value`, which reads p, or a 2D one, which reads uv.
    void AddChecks(bool isSpectrum, int dimension, float value = 1) {
        TextureEntity& t = description.textures.emplace_back();
        t.name = "checkerboard";
        t.textureName = "checks";
        t.isSpectrum = isSpectrum;
        t.loc = LocAt(1);
        t.parameters.Add(Int("dimension", dimension));
        t.parameters.Add(isSpectrum ? Grey("tex1", value) : Float("tex1", value));
    }
    TextureTable textures;
    // Throws Error, as Compile() does.
    MaterialTable Make() {
        textures = TextureTable(description, warnings);
        MaterialTable table(description, textures, warnings);
        warnings.ThrowErrors();
        return table;
    }
    // Make the Bsdf of a hit, which a bump map changes, and that of a material at a simple hit.
    Bsdf MakeBsdf(SurfaceInteraction* hit) { return Make().MakeBsdf(textures, hit); }
    Bsdf MakeBsdf(SurfaceInteraction hit) { return MakeBsdf(&hit); }
    Bsdf MakeBsdf(int material, const Vec3f& p = Vec3f(0.5f, 0.5f, 0.5f)) {
        return MakeBsdf(Hit(material, p));
    }
    static SurfaceInteraction Hit(int material, const Vec3f& p = Vec3f(0.5f, 0.5f, 0.5f)) {
        SurfaceInteraction hit;
        hit.p = p;
        hit.pError = Vec3f::Zero();
        hit.n = hit.ns = hit.wo = Vec3f::UnitZ();
        hit.uv = {0.25f, 0.25f};
        hit.dpdu = Vec3f(0, 2, 0);
        hit.dpdv = Vec3f(-2, 0, 0);
        hit.dndu = hit.dndv = Vec3f::Zero();
        hit.material = material;
        return hit;
    }
};

template <typename L>
L LobeAt(const Bsdf& bsdf, int i) {
    EXPECT_TRUE(std::holds_alternative<L>(bsdf.At(i))) << "lobe " << i;
    return std::get<L>(bsdf.At(i));
}

inline void ExpectGrey(const StoredRgb& c, float value) {
    for (float v : {c.r, c.g, c.b}) EXPECT_FLOAT_EQ(v, value);
}

// Returns the message of the error that making the materials throws, "" for none.
inline std::string ErrorOf(MaterialScene* b) {
    return lull::ErrorOf([&] { b->Make(); });
}

}  // namespace lull::test
