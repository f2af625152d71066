// Multiplies two textures.
#pragma once

#include "renderer/scene/textures/texture_input.h"

namespace lull {

template <typename T>
struct Scale {
    TextureHandle<T> tex1, tex2;
};

template <typename T>
T Evaluate(const Scale<T>& scale, const TextureTable& table, const TextureContext& c) {
    return table.Evaluate(scale.tex1, c) * table.Evaluate(scale.tex2, c);
}

template <typename T>
SurfaceNeeds Needs(const Scale<T>& scale, const TextureTable& table) {
    return table.Needs(scale.tex1) | table.Needs(scale.tex2);
}

template <typename T>
Made<T, Scale<T>> MakeScale(const TextureInput& input) {
    const auto tex1 = GetTexture<T>(input, "tex1", 1);
    const auto tex2 = GetTexture<T>(input, "tex2", 1);
    if (tex1.IsConstant() && tex2.IsConstant())
        return TextureHandle<T>{tex1.constant * tex2.constant};
    if (IsConstant(tex1, 1) || IsConstant(tex2, 0)) return tex2;
    if (IsConstant(tex2, 1) || IsConstant(tex1, 0)) return tex1;
    return Scale<T>{tex1, tex2};
}

}  // namespace lull
