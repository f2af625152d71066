#pragma once

#include <memory>

#include "renderer/scene/lights/environment_map.h"
#include "renderer/scene/lights/light_bounds.h"
#include "renderer/scene/lights/light_reader.h"
#include "renderer/scene/lights/light_sample.h"

namespace lull {

// Surrounds the scene with radiance: constant, or an image in latitude-longitude form whose
// brightness guides the sampling (pbrt 3rd ed., 14.2.4).
class InfiniteLight {
  public:
    static constexpr LightType kType = LightType::Infinite;

    // Reads the image, if any. Throws Error if it cannot be read; texels that are not finite, and
    // negative parts of others, count as black, with a counted warning.
    static InfiniteLight Make(const LightReader&);

    std::optional<LightSample> Sample(const Vec3f& from, const Vec2f& u) const;
    Emitted LeAndPdf(const Vec3f& w) const;
    // Returns the radiance of a sample that is on the map.
    Rgb Radiance(const LightSample& sample) const { return map->Radiance(sample.p.head<2>()); }

    std::optional<LightBounds> Bounds() const { return {}; }
    Rgb Power() const;

  private:
    // Returns the solid angle in light space over that in the world, about the direction `w` of the
    // world: 1 unless the transform scales unevenly.
    float Stretch(const Vec3f& w) const;

    Mat3f lightFromWorld = Mat3f::Identity(), worldFromLight = Mat3f::Identity();
    float worldRadius = 1;
    float stretch = 0;           // |determinant| of lightFromWorld; 0: the transform scales evenly
    Rgb constant = Rgb::Ones();  // where there is no map
    std::shared_ptr<const EnvironmentMap> map;  // null: none
};

}  // namespace lull
