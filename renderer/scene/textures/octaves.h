// Varies in space by several octaves of noise: smoothly (fbm, fractional Brownian motion) or with
// creases (wrinkled, turbulence).
#pragma once

#include "renderer/scene/textures/mapping.h"
#include "renderer/scene/textures/noise.h"

namespace lull {

using OctaveSum = float (*)(const Vec3f& p, float spacing2, float roughness, int octaves);

template <typename T, OctaveSum sum>
struct Octaves {
    Mapping3D mapping;
    float roughness;
    int octaves;
};
template <typename T>
using Fbm = Octaves<T, FractionalBrownianMotion>;
template <typename T>
using Wrinkled = Octaves<T, Turbulence>;

// Reads "octaves". Beyond 64 float coordinates have no fraction left for noise to show.
inline int GetOctaves(const TextureInput& input) {
    return std::clamp(input.entity.parameters.GetInt("octaves", 8), 0, 64);
}

template <typename T, OctaveSum sum>
T Evaluate(const Octaves<T, sum>& texture, const TextureTable&, const TextureContext& c) {
    const float v = sum(Map(texture.mapping, c), Spacing2(texture.mapping, c), texture.roughness,
                        texture.octaves);
    if constexpr (std::is_same_v<T, float>)
        return v;
    else
        return Rgb::Constant(v);
}

template <typename T, OctaveSum sum>
SurfaceNeeds Needs(const Octaves<T, sum>&, const TextureTable&) {
    return kNeedsFootprint;
}

template <typename T, OctaveSum sum>
Made<T, Octaves<T, sum>> MakeOctaves(const TextureInput& input) {
    return Octaves<T, sum>{MakeMapping3D(input),
                           input.entity.parameters.GetFloat("roughness", 0.5f), GetOctaves(input)};
}

}  // namespace lull
