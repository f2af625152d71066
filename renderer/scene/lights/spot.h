#pragma once

#include "renderer/scene/lights/light_bounds.h"
#include "renderer/scene/lights/light_reader.h"
#include "renderer/scene/lights/light_sample.h"

namespace lull {

// Emits I, W/sr, from one point into a cone, falling off smoothly towards its edge: by the fourth
// power of how far the cosine is from the edge's ("spot"), or by its square, as
// KHR_lights_punctual proposes ("spot-squared").
struct SpotLight {
    static constexpr LightType kType = LightType::DeltaPosition;

    Vec3f p, axis;
    Rgb I;
    float cosTotalWidth, cosFalloffStart;
    bool isSquared = false;

    static SpotLight Make(const LightReader&);
    std::optional<LightSample> Sample(const Vec3f& from, const Vec2f& u) const;
    std::optional<LightBounds> Bounds() const;
    Rgb Power() const { return 2 * kPi * (1 - 0.5f * (cosFalloffStart + cosTotalWidth)) * I; }
};

}  // namespace lull
