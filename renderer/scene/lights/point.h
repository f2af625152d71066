// Lights at points.
#pragma once

#include "renderer/scene/lights/emission_profile.h"
#include "renderer/scene/lights/light_bounds.h"
#include "renderer/scene/lights/light_image.h"
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

// Emits I, W/sr, along the axis of a cone from one point ("spot", and "spot-squared").
struct SpotLight {
    static constexpr LightType kType = LightType::DeltaPosition;

    Vec3f p;
    Rgb I;
    SpotCone cone;

    static SpotLight Make(const LightReader&);
    std::optional<LightSample> Sample(const Vec3f& from, const Vec2f& u) const;
    std::optional<LightBounds> Bounds() const;
    Rgb Power() const { return cone.SolidAngle() * I; }
};

// Emits from one point by an image in latitude-longitude form, about the y axis of the light's
// space: I times its texels, W/sr (pbrt 3rd ed., 12.3.3).
struct GoniometricLight {
    static constexpr LightType kType = LightType::DeltaPosition;

    Vec3f p;
    Rgb I;
    Mat3f lightFromWorld;
    std::shared_ptr<const LightImage> image;  // null: I in all directions

    // Throws Error if the image cannot be read.
    static GoniometricLight Make(const LightReader&);
    std::optional<LightSample> Sample(const Vec3f& from, const Vec2f& u) const;
    std::optional<LightBounds> Bounds() const;
    Rgb Power() const { return image ? Rgb(4 * kPi * I * image->mean) : Rgb(4 * kPi * I); }
};

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
