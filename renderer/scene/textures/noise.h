// Computes Perlin's improved noise and sums of it.
#pragma once

#include "renderer/base/math.h"

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

}  // namespace lull
