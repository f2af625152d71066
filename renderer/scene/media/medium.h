// Interaction of a ray with a medium.
#pragma once

#include <optional>
#include <vector>

#include "renderer/base/math.h"
#include "renderer/base/sampler.h"

namespace lull {

struct MediumSample {
    std::optional<float> t =
        {};                    // where the ray scatters, in units of its direction; none: it passes
    Rgb weight = Rgb::Ones();  // factor of the path's throughput, either way
};

// Represents a medium that is the same everywhere.
struct HomogeneousMedium {
    Rgb sigmaS, sigmaT;  // scattering and extinction, per unit of length
    float g;             // of the phase function

    // Returns the share of light that passes through `length` of the medium, which may be infinite.
    Rgb Transmittance(float length) const {
        return (-sigmaT * std::min(length, std::numeric_limits<float>::max())).exp();
    }

    // Of a ray, whose direction is unit, up to its tMax.
    Rgb Transmittance(const Ray& ray, Sampler&) const { return Transmittance(ray.tMax); }

    // Finds where the ray, of unit direction, scatters: at a distance by the extinction of one
    // channel, chosen uniformly (pbrt 3rd ed., 15.2.1).
    MediumSample Sample(const Ray& ray, Sampler& sampler) const {
        const float length = ray.tMax;
        // A purely absorbing medium attenuates every path, instead of ending some.
        if (IsBlack(sigmaS)) return {.weight = Transmittance(length)};
        const int channel = std::min(int(sampler.Get1D() * 3), 2);
        const float depth = -std::log1p(-sampler.Get1D());
        const float distance = sigmaT[channel] > 0 ? depth / sigmaT[channel] : kInfinity;
        const bool scatters = distance < length;
        const Rgb through = Transmittance(std::min(distance, length));
        const Rgb density = scatters ? Rgb(sigmaT * through) : through;
        const float pdf = density.mean();
        if (!(pdf > 0)) return {.weight = Rgb::Zero()};
        if (!scatters) return {.weight = through / pdf};
        return {.t = distance, .weight = through * sigmaS / pdf};
    }
};

// Represents a medium whose density is given by a grid, which fills the unit cube of its own space.
// The densities are at the centres of cells, and 0 beyond the outermost; outside there is nothing.
struct GridMedium {
    float sigmaT;  // greatest extinction per unit of length in the world where the density is 1
    Rgb albedo;    // scattering over that
    std::optional<Rgb> tint = {};  // extinction over that, where colours differ
    float g;                       // of the phase function
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
