// Noise, and textures made of it.
#pragma once

#include "renderer/base/math.h"
#include "renderer/scene/textures/mapping.h"

namespace lull {

// Returns gradient noise at p, about [-1, 1], 0 on the integer lattice, of period 256 (Perlin
// 2002, "Improving Noise", with the choice of gradients of pbrt-v3). Coordinates beyond 2^30,
// infinite ones and NaN count as 0.
float Noise(const Vec3f& p);

// Sums at most `octaves` octaves of noise: sum_i roughness^i Noise(1.99^i p). The ratio is not 2 so
// that the zeros of the octaves do not coincide. Octaves finer than twice the distance between
// samples, whose square is `spacing2`, are left out and the last one fades (pbrt-v3's FBm).
float FractionalBrownianMotion(const Vec3f& p, float spacing2, float roughness, int octaves);

// Sums the magnitudes of octaves in the same way; each octave that is left out counts as 0.2, the
// mean of its magnitude (pbrt-v3's Turbulence).
float Turbulence(const Vec3f& p, float spacing2, float roughness, int octaves);

// Varies in space by several octaves of noise: smoothly (fbm, fractional Brownian motion) or with
// creases (wrinkled, turbulence).
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
    return Filled<T>(sum(Map(texture.mapping, c), Spacing2(texture.mapping, c), texture.roughness,
                         texture.octaves));
}

template <typename T, OctaveSum sum>
Made<T, Octaves<T, sum>> MakeOctaves(const TextureInput& input) {
    return Octaves<T, sum>{MakeMapping3D(input),
                           input.entity.parameters.GetFloat("roughness", 0.5f), GetOctaves(input)};
}

// Ripples like water under wind: waves whose height is set by another, coarser noise.
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
    return Filled<T>(v);
}

template <typename T>
Made<T, Windy<T>> MakeWindy(const TextureInput& input) {
    return Windy<T>{MakeMapping3D(input)};
}

// Draws veins of marble: a sine along y, disturbed by noise, coloured by a spline.
struct Marble {
    Mapping3D mapping;
    float roughness;
    int octaves;
    float scale;
    float variation;  // how far noise shifts the sine, in radians
};

Rgb Evaluate(const Marble& marble, const TextureTable&, const TextureContext& c);

inline Made<Rgb, Marble> MakeMarble(const TextureInput& input) {
    const Parameters& parameters = input.entity.parameters;
    return Marble{MakeMapping3D(input), parameters.GetFloat("roughness", 0.5f), GetOctaves(input),
                  parameters.GetFloat("scale", 1), parameters.GetFloat("variation", 0.2f)};
}

}  // namespace lull
