#pragma once

#include "renderer/scene/lights/light_bounds.h"
#include "renderer/scene/lights/light_image.h"
#include "renderer/scene/lights/light_reader.h"
#include "renderer/scene/lights/light_sample.h"

namespace lull {

// Projects an image from one point along z of the light's space: I times its texels, W/sr (pbrt
// 3rd ed., 12.3.2). The field of view is across the image's shorter side; its first row is at the
// lowest y.
struct ProjectionLight {
    static constexpr LightType kType = LightType::DeltaPosition;

    Vec3f p;
    Rgb I;
    Mat3f lightFromWorld;
    Vec2f screen;      // half the size of the image on the plane at distance 1, times perTangent
    float perTangent;  // 1 / tan(fov / 2)
    std::shared_ptr<const LightImage> image;  // null: white

    // Throws Error for a field of view outside (0, 180) or an image that cannot be read.
    static ProjectionLight Make(const LightReader&);
    std::optional<LightSample> Sample(const Vec3f& from, const Vec2f& u) const;
    std::optional<LightBounds> Bounds() const;
    Rgb Power() const;
};

}  // namespace lull
