// Ripples like water under wind: waves whose height is set by another, coarser noise.
#pragma once

#include "renderer/scene/textures/octaves.h"

namespace lull {

template <typename T>
struct Windy {
    Mapping3D mapping;
};

template <typename T>
T Evaluate(const Windy<T>& windy, const TextureTable&, const TextureContext& c) {
    const Vec3f p = Map(windy.mapping, c);
    const float spacing2 = Spacing2(windy.mapping, c);
    const float wind = FractionalBrownianMotion(0.1f * p, Sqr(0.1f) * spacing2, 0.5f, 3);
    const float v = std::abs(wind) * FractionalBrownianMotion(p, spacing2, 0.5f, 6);
    if constexpr (std::is_same_v<T, float>)
        return v;
    else
        return Rgb::Constant(v);
}

template <typename T>
SurfaceNeeds Needs(const Windy<T>&, const TextureTable&) {
    return kNeedsFootprint;
}

template <typename T>
Made<T, Windy<T>> MakeWindy(const TextureInput& input) {
    return Windy<T>{MakeMapping3D(input)};
}

}  // namespace lull
