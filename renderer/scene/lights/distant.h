// Lights in one direction, without size or with.
#pragma once

#include "renderer/scene/lights/light_bounds.h"
#include "renderer/scene/lights/light_reader.h"
#include "renderer/scene/lights/light_sample.h"

namespace lull {

// Emits L, W/(m^2 sr) times the solid angle it stands for, from one direction.
struct DistantLight {
    static constexpr LightType kType = LightType::DeltaDirection;

    Vec3f w;  // towards the light, unit
    Rgb L;
    float worldRadius = 1;

    static DistantLight Make(const LightReader&);
    std::optional<LightSample> Sample(const Vec3f& from, const Vec2f& u) const;
    std::optional<LightBounds> Bounds() const { return {}; }
    Rgb Power() const { return kPi * Sqr(worldRadius) * L; }
};

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
