// Inputs of the functions that read textures.
#pragma once

#include <variant>

#include "renderer/input/description.h"
#include "renderer/scene/textures/texture.h"
#include "renderer/scene/textures/texture_image.h"

namespace lull {

struct TextureInput {
    const TextureEntity& entity;
    const Description& description;
    const TextureTable& table;  // holds all textures before this one
    TextureImages& images;
    Warnings& warnings;
};

// The result of a maker: a new texture of its kind, or the handle of an equivalent texture or
// constant.
template <typename T, typename Kind>
using Made = std::variant<TextureHandle<T>, Kind>;

// Reads a texture parameter of type T, float or Rgb.
template <typename T>
TextureHandle<T> GetTexture(const TextureInput& input, const std::string& name, float otherwise) {
    if constexpr (std::is_same_v<T, float>)
        return input.table.GetFloat(input.entity, name, otherwise);
    else
        return input.table.GetSpectrum(input.entity, name, Rgb::Constant(otherwise));
}

template <typename T>
TextureHandle<T> ConstantTexture(float value) {
    if constexpr (std::is_same_v<T, float>)
        return {value};
    else
        return {Rgb::Constant(value)};
}

// Compare constants of either type.
inline bool AllEqual(float a, float b) { return a == b; }
inline bool AllEqual(const Rgb& a, const Rgb& b) { return (a == b).all(); }
inline bool IsConstant(const FloatTexture& t, float value) {
    return t.IsConstant() && t.constant == value;
}
inline bool IsConstant(const SpectrumTexture& t, float value) {
    return t.IsConstant() && (t.constant == value).all();
}

}  // namespace lull
