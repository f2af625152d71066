#pragma once

#include "renderer/scene/lights/light_bounds.h"
#include "renderer/scene/lights/light_image.h"
#include "renderer/scene/lights/light_reader.h"
#include "renderer/scene/lights/light_sample.h"

namespace lull {

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

}  // namespace lull
