#pragma once

#include "renderer/scene/lights/light_bounds.h"
#include "renderer/scene/lights/light_reader.h"
#include "renderer/scene/lights/light_sample.h"

namespace lull {

// Emits I, W/sr, equally in all directions from one point.
struct PointLight {
    static constexpr LightType kType = LightType::DeltaPosition;

    Vec3f p;
    Rgb I;

    static PointLight Make(const LightReader&);
    std::optional<LightSample> Sample(const Vec3f& from, const Vec2f& u) const;
    Rgb Power() const { return 4 * kPi * I; }
    std::optional<LightBounds> Bounds() const;
};

}  // namespace lull
