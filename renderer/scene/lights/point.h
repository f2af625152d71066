#pragma once

#include "renderer/input/description.h"
#include "renderer/scene/lights/light_bounds.h"
#include "renderer/scene/lights/light_sample.h"

namespace lull {

// Emits I, W/sr, equally in all directions from one point.
struct PointLight {
    Vec3f p;
    Rgb I;

    static PointLight Make(const LightEntity&, Warnings&);
    std::optional<LightSample> Sample(const Vec3f& from) const;
    Rgb Power() const { return 4 * kPi * I; }
    LightBounds Bounds() const;
};

}  // namespace lull
