#pragma once

#include <memory>

#include "renderer/input/description.h"
#include "renderer/scene/lights/environment_map.h"
#include "renderer/scene/lights/light_sample.h"

namespace lull {

// Surrounds the scene with radiance: constant, or an image in latitude-longitude form whose
// brightness guides the sampling (pbrt 3rd ed., 14.2.4).
class InfiniteLight {
  public:
    // Reads the image, if any. Throws Error if it cannot be read; texels that are negative or not
    // finite count as black, with a counted warning. `isCompensated`: see EnvironmentMap.
    static InfiniteLight Make(const Description&, const LightEntity&, float worldRadius,
                              bool isCompensated, Warnings&);

    // Returns the radiance that arrives from direction w (unit, world).
    Rgb Le(const Vec3f& w) const;
    std::optional<LightSample> Sample(const Vec2f& u) const;
    // Returns the density, 1/sr, with which Sample finds w.
    float Pdf(const Vec3f& w) const;
    Rgb Power() const;

  private:
    Mat3f lightFromWorld = Mat3f::Identity(), worldFromLight = Mat3f::Identity();
    float worldRadius = 1;
    Rgb constant = Rgb::Ones();                 // where there is no map
    std::shared_ptr<const EnvironmentMap> map;  // null: none
};

}  // namespace lull
