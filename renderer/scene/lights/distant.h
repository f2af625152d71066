#pragma once

#include "renderer/input/description.h"
#include "renderer/scene/lights/light_sample.h"

namespace lull {

// Emits L, W/(m^2 sr) times the solid angle it stands for, from one direction.
struct DistantLight {
    Vec3f w;  // towards the light, unit
    Rgb L;
    float worldRadius = 1;

    static DistantLight Make(const LightEntity&, float worldRadius, Warnings&);
    std::optional<LightSample> Sample() const;
    Rgb Power() const { return kPi * Sqr(worldRadius) * L; }
};

}  // namespace lull
