// Interpolates between two textures by a third.
#pragma once

#include "renderer/scene/textures/texture_input.h"

namespace lull {

template <typename T>
struct Mix {
    TextureHandle<T> tex1, tex2;
    FloatTexture amount;  // 0: tex1; 1: tex2; not clamped
};

template <typename T>
T Evaluate(const Mix<T>& mix, const TextureTable& table, const TextureContext& c) {
    const float amount = table.Evaluate(mix.amount, c);
    return (1 - amount) * table.Evaluate(mix.tex1, c) + amount * table.Evaluate(mix.tex2, c);
}

template <typename T>
SurfaceNeeds Needs(const Mix<T>& mix, const TextureTable& table) {
    return table.Needs(mix.tex1) | table.Needs(mix.tex2) | table.Needs(mix.amount);
}

template <typename T>
Made<T, Mix<T>> MakeMix(const TextureInput& input) {
    const Mix<T> mix{GetTexture<T>(input, "tex1", 0), GetTexture<T>(input, "tex2", 1),
                     GetTexture<float>(input, "amount", 0.5f)};
    if (IsConstant(mix.amount, 0)) return mix.tex1;
    if (IsConstant(mix.amount, 1)) return mix.tex2;
    if (mix.tex1.IsConstant() && mix.tex2.IsConstant()) {
        const T &a = mix.tex1.constant, &b = mix.tex2.constant;
        if (AllEqual(a, b)) return mix.tex1;
        if (mix.amount.IsConstant())
            return TextureHandle<T>{T((1 - mix.amount.constant) * a + mix.amount.constant * b)};
    }
    return mix;
}

}  // namespace lull
