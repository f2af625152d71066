#pragma once

#include "renderer/scene/lights/distant.h"

namespace lull {

// A distant light of some size: a disc that emits evenly, and gives a surface that faces it the
// irradiance of the parallel light, L. Rays that leave the scene see it.
struct SunLight {
    static constexpr LightType kType = LightType::Infinite;

    Vec3f w;       // towards its centre, unit
    Rgb L;         // radiance
    float height;  // 1 - cos of the disc's radius
    float solidAngle;
    Rgb power;

    // Takes the angle across the disc, radians, in (0, pi].
    SunLight(const DistantLight& parallel, double angle);

    std::optional<LightSample> Sample(const Vec3f& from, const Vec2f& u) const;
    Emitted LeAndPdf(const Vec3f& direction) const {
        // Of nearly parallel vectors, the product is less precise than the difference.
        if ((direction - w).squaredNorm() > 2 * height) return {Rgb::Zero(), 0};
        return {L, 1 / solidAngle};
    }
    std::optional<LightBounds> Bounds() const { return {}; }
    Rgb Power() const { return power; }
};

}  // namespace lull
