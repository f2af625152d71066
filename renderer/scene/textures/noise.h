// Computes Perlin's improved noise and sums of it.
#pragma once

#include "renderer/base/math.h"

namespace lull {

// Returns gradient noise at p, about [-1, 1], 0 on the integer lattice, of period 256 (Perlin
// 2002, "Improving Noise", with the choice of gradients of pbrt-v3). Coordinates beyond 2^30,
// infinite ones and NaN count as 0.
float Noise(const Vec3f& p);

// Sums `octaves` octaves of noise: sum_i roughness^i Noise(1.99^i p). The ratio is not 2 so that
// the zeros of the octaves do not coincide. This is pbrt-v3's FBm without differentials.
float FractionalBrownianMotion(const Vec3f& p, float roughness, int octaves);

}  // namespace lull
