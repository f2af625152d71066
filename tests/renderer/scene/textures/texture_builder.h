// Builds descriptions of textures for tests, as a parser would.
#pragma once

#include <fmt/core.h>

#include "renderer/scene/textures/texture.h"
#include "tests/renderer/scene/parameters.h"

namespace lull {

// Makes a shape's directive, at line 3.
inline ShapeEntity ShapeOf(const std::string& name, const std::vector<Parameter>& parameters) {
    ShapeEntity entity;
    entity.name = name;
    entity.loc = LocAt(3);
    for (const Parameter& p : parameters) entity.parameters.Add(p);
    return entity;
}

// Collects textures and makes the table of them.
struct TextureBuilder {
    Description description;
    Warnings warnings;

    explicit TextureBuilder(bool substitutes = false) : warnings({}, substitutes) {}

    // Adds a texture at line 10, 11, ...; returns its place.
    int Add(bool isSpectrum, const std::string& kind, std::vector<Parameter> parameters,
            const Mat4d& worldFromTexture = Mat4d::Identity()) {
        const int index = int(description.textures.size());
        TextureEntity entity;
        entity.name = kind;
        entity.textureName = fmt::format("t{}", index);
        entity.loc = LocAt(10 + index);
        entity.isSpectrum = isSpectrum;
        entity.worldFromTexture = worldFromTexture;
        for (Parameter& p : parameters) entity.parameters.Add(std::move(p));
        description.textures.push_back(std::move(entity));
        return index;
    }

    // Makes a parameter that names texture `index`; -1 stands for a name that there is not.
    Parameter Ref(const std::string& name, int index) const {
        TextureRef ref{fmt::format("t{}", index), -1, -1};
        if (index >= 0)
            (description.textures[size_t(index)].isSpectrum ? ref.spectrumIndex : ref.floatIndex) =
                index;
        return {ParameterType::Texture, name, LocAt(7), std::vector<TextureRef>{ref}};
    }

    // Throws Error, as Compile() does.
    TextureTable Build() {
        TextureTable table(description, warnings);
        warnings.ThrowErrors();
        return table;
    }

    FloatTexture Float(const TextureTable& table, int index) const {
        Entity entity;
        entity.parameters.Add(Ref("x", index));
        return table.GetFloat(entity, "x", -99);
    }
    SpectrumTexture Spectrum(const TextureTable& table, int index) const {
        Entity entity;
        entity.parameters.Add(Ref("x", index));
        return table.GetSpectrum(entity, "x", Rgb::Constant(-99));
    }
};

inline TextureContext At(float u, float v) { return {Vec3f::Zero(), {u, v}}; }
inline TextureContext AtPoint(const Vec3f& p) { return {p, Vec2f::Zero()}; }

}  // namespace lull
