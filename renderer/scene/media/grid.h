// Represents a medium whose density is given by a grid.
#pragma once

#include <vector>

#include "renderer/base/sampler.h"
#include "renderer/scene/media/medium_sample.h"

namespace lull {

// Fills the unit cube of its own space; outside there is nothing. The densities are at the centres
// of cells, and 0 beyond the outermost.
struct GridMedium {
    float sigmaT;  // extinction per unit of length in the world where the density is 1
    Rgb albedo;
    float g;  // of the phase function
    Vec3i size = Vec3i::Ones();
    std::vector<float> density;  // x fastest, then y
    float maxDensity = 0;
    Mat4d gridFromWorld = Mat4d::Identity();

    // Interpolates the density at a point of grid space.
    float Density(const Vec3f& p) const;

    // Estimates the transmittance along the ray, whose direction is unit, up to tMax: by ratio
    // tracking, with Russian roulette below 0.1 (pbrt-v3; Novak et al. 2014).
    Rgb Transmittance(const Ray& worldRay, Sampler& sampler) const;

    // Finds where the ray, of unit direction, scatters: by delta tracking (Woodcock et al. 1965).
    MediumSample Sample(const Ray& worldRay, Sampler& sampler) const;
};

}  // namespace lull
