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

}  // namespace lull
