// Varies smoothly in space: fractional Brownian motion.
#pragma once

#include "renderer/scene/textures/mapping.h"
#include "renderer/scene/textures/noise.h"

namespace lull {

template <typename T>
struct Fbm {
    Mapping3D mapping;
    float roughness;
    int octaves;
};

// Reads "octaves". Beyond 64 no float coordinate has a fraction left that noise could show.
inline int GetOctaves(const TextureInput& input) {
    return std::clamp(input.entity.parameters.GetInt("octaves", 8), 0, 64);
}

template <typename T>
T Evaluate(const Fbm<T>& fbm, const TextureTable&, const TextureContext& c) {
    const float v = FractionalBrownianMotion(Map(fbm.mapping, c), Spacing2(fbm.mapping, c),
                                             fbm.roughness, fbm.octaves);
    if constexpr (std::is_same_v<T, float>)
        return v;
    else
        return Rgb::Constant(v);
}

template <typename T>
SurfaceNeeds Needs(const Fbm<T>&, const TextureTable&) {
    return kNeedsFootprint;
}

template <typename T>
Made<T, Fbm<T>> MakeFbm(const TextureInput& input) {
    return Fbm<T>{MakeMapping3D(input), input.entity.parameters.GetFloat("roughness", 0.5f),
                  GetOctaves(input)};
}

}  // namespace lull
