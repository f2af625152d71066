// Builds descriptions of materials and textures for tests, and looks into the Bsdfs made of them.
#pragma once

#include <gtest/gtest.h>

#include "renderer/scene/material.h"

namespace lull::test {

using DielectricReflection = MicrofacetReflection<DielectricInterface>;
using ConductorReflection = MicrofacetReflection<ConductorInterface>;

inline FileLoc At(int line) { return {std::make_shared<const std::string>("scene.pbrt"), line}; }

// Builds descriptions of materials and textures.
struct MaterialScene {
    Description description;
    std::vector<std::string> messages;
    Warnings warnings;

    explicit MaterialScene(bool substitutes = false)
        : warnings([this](const std::string& m) { messages.push_back(m); }, substitutes) {}

    MaterialEntity& AddMaterial(const std::string& kind) {
        MaterialEntity& m = description.materials.emplace_back();
        m.name = kind;
        m.loc = At(10 * int(description.materials.size()));
        return m;
    }
    // Adds a 3D checkerboard of 0 and `value`, which reads p, or a 2D one, which reads uv.
    void AddChecks(bool isSpectrum, int dimension, float value = 1) {
        TextureEntity& t = description.textures.emplace_back();
        t.name = "checkerboard";
        t.textureName = "checks";
        t.isSpectrum = isSpectrum;
        t.loc = At(1);
        t.parameters.Add({ParameterType::Integer, "dimension", At(2), std::vector<int>{dimension}});
        if (isSpectrum)
            t.parameters.Add(
                {ParameterType::Spectrum, "tex1", At(2), std::vector<float>(3, value)});
        else
            t.parameters.Add({ParameterType::Float, "tex1", At(2), std::vector<float>{value}});
    }
    TextureTable textures;
    // Throws Error, as Compile() does.
    MaterialTable Make() {
        textures = TextureTable(description, warnings);
        MaterialTable table(description, textures, warnings);
        warnings.ThrowErrors();
        return table;
    }
    // Makes the Bsdf of a material at a simple hit.
    Bsdf MakeBsdf(int material, const Vec3f& p = Vec3f(0.5f, 0.5f, 0.5f)) {
        const MaterialTable table = Make();
        SurfaceInteraction hit = Hit(material, p);
        return table.MakeBsdf(textures, &hit);
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

inline void AddFloat(MaterialEntity* m, const std::string& name, float value) {
    m->parameters.Add({ParameterType::Float, name, At(3), std::vector<float>{value}});
}
inline void AddBool(MaterialEntity* m, const std::string& name, bool value) {
    m->parameters.Add({ParameterType::Bool, name, At(3), std::vector<int>{value}});
}
inline void AddRgb(MaterialEntity* m, const std::string& name, const Rgb& c) {
    m->parameters.Add(
        {ParameterType::Spectrum, name, At(3), std::vector<float>{c.x(), c.y(), c.z()}});
}
inline void AddGrey(MaterialEntity* m, const std::string& name, float value) {
    AddRgb(m, name, Rgb::Constant(value));
}
inline void AddTexture(MaterialEntity* m, const std::string& name, int texture, bool isSpectrum) {
    TextureRef ref{"checks"};
    (isSpectrum ? ref.spectrumIndex : ref.floatIndex) = texture;
    m->parameters.Add({ParameterType::Texture, name, At(3), std::vector<TextureRef>{ref}});
}

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
    try {
        b->Make();
    } catch (const Error& e) {
        return e.what();
    }
    return "";
}

}  // namespace lull::test
