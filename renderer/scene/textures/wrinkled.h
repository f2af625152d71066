// Varies in space with creases: turbulence.
#pragma once

#include "renderer/scene/textures/fbm.h"

namespace lull {

template <typename T>
struct Wrinkled {
    Mapping3D mapping;
    float roughness;
    int octaves;
};

template <typename T>
T Evaluate(const Wrinkled<T>& wrinkled, const TextureTable&, const TextureContext& c) {
    const float v = Turbulence(Map(wrinkled.mapping, c), Spacing2(wrinkled.mapping, c),
                               wrinkled.roughness, wrinkled.octaves);
    if constexpr (std::is_same_v<T, float>)
        return v;
    else
        return Rgb::Constant(v);
}

template <typename T>
SurfaceNeeds Needs(const Wrinkled<T>&, const TextureTable&) {
    return kNeedsFootprint;
}

template <typename T>
Made<T, Wrinkled<T>> MakeWrinkled(const TextureInput& input) {
    return Wrinkled<T>{MakeMapping3D(input), input.entity.parameters.GetFloat("roughness", 0.5f),
                       GetOctaves(input)};
}

}  // namespace lull
