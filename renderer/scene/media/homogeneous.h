// Represents a medium that is the same everywhere.
#pragma once

#include "renderer/base/sampler.h"
#include "renderer/scene/media/medium_sample.h"

namespace lull {

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

}  // namespace lull
