// Interaction of a ray with a medium.
#pragma once

#include <optional>
#include <variant>

#include "renderer/base/math.h"
#include "renderer/base/sampler.h"
#include "renderer/scene/media/grids.h"

namespace lull {

struct MediumSample {
    std::optional<float> t =
        {};                    // where the ray scatters, in units of its direction; none: it passes
    Rgb weight = Rgb::Ones();  // factor of the path's throughput, either way
    Rgb emitted = Rgb::Zero();  // radiance of the medium itself that gets to the ray's origin
};

struct HomogeneousMedium {
    Rgb sigmaS, sigmaT;          // scattering and extinction, per unit of length
    float g;                     // of the phase function
    Rgb emission = Rgb::Zero();  // radiance per unit of length

    // Returns the share of light that passes through `length` of the medium, which may be infinite.
    Rgb Transmittance(float length) const {
        return (-sigmaT * std::min(length, std::numeric_limits<float>::max())).exp();
    }

    // Of a ray, whose direction is unit, up to its tMax.
    Rgb Transmittance(const Ray& ray, Sampler&) const { return Transmittance(ray.tMax); }

    // Finds where the ray, of unit direction, scatters: at a distance by the extinction of one
    // channel, chosen uniformly (pbrt 3rd ed., 15.2.1).
    MediumSample Sample(const Ray& ray, Sampler& sampler) const {
        MediumSample sample = Scatter(ray, sampler);
        if (!IsBlack(emission)) sample.emitted = Emitted(ray.tMax);
        return sample;
    }

    // Returns the radiance that `length` of the medium sends unscattered to its start.
    Rgb Emitted(float length) const {
        const float finite = std::min(length, std::numeric_limits<float>::max());
        const Rgb lost = -(-sigmaT * finite).unaryExpr([](float x) { return std::expm1(x); });
        return (sigmaT > 0).select(emission * lost / sigmaT, Rgb::Zero());
    }

  private:
    MediumSample Scatter(const Ray& ray, Sampler& sampler) const {
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

// The radiance with which the absorption of a medium counts: a product, of what there is.
struct MediumEmission {
    Rgb Le = Rgb::Ones();
    std::optional<Grid<float>> scale = {};
    std::optional<Grid<Rgb>> color = {};
    std::optional<Temperatures> temperatures = {};

    Rgb operator()(const Vec3f& p) const;
};

// A medium whose density is a grid or a formula in the unit cube of its own space, 0 outside.
struct GridMedium {
    float sigmaT;  // greatest extinction per unit of length in the world where the density is 1
    Rgb albedo;    // scattering over that
    Rgb absorption = Rgb::Zero();  // over that
    std::optional<Rgb> tint = {};  // extinction over that, where colours differ
    float g;                       // of the phase function
    std::variant<Grid<float>, RgbDensity, CloudDensity, SparseGrid> density = {};
    float maxDensity = 0;
    Mat4d gridFromWorld = Mat4d::Identity();
    std::optional<MediumEmission> emission = {};

    // Estimates the transmittance along the ray, whose direction is unit, up to tMax: by ratio
    // tracking, with Russian roulette below 0.1 (pbrt-v3; Novak et al. 2014).
    Rgb Transmittance(const Ray& worldRay, Sampler& sampler) const;

    // Finds where the ray, of unit direction, scatters: by delta tracking (Woodcock et al. 1965).
    // Each tentative collision adds its share of the emission.
    MediumSample Sample(const Ray& worldRay, Sampler& sampler) const;
};

}  // namespace lull
