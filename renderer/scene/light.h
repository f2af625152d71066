// What lights a scene: all kinds of light, and what each of them does.
//
// A kind is a struct L, in a file of lights/, with
//
//     static constexpr LightType kType
//     std::optional<LightSample> Sample(const Vec3f& from, const Vec2f& u) const
//         returns light that may arrive at `from`, nothing where none does;
//     Rgb Power() const
//         returns W; of lights without a place, what crosses the disk of the scene's radius;
//     std::optional<LightBounds> Bounds() const
//         returns where it is and where it shines; nothing if it has no place,
//
// one of type Area, on which rays end,
//
//     Rgb Le(const Vec3f& n, const Vec3f& w, const Hit&) const
//         returns the radiance that leaves a hit with normal n towards w;
//     float Pdf(const Vec3f& from, const Vec3f& p, const Vec3f& n) const
//         returns the density, 1/sr, with which Sample finds the point p with normal n,
//
// and one of type Infinite, which rays reach when they leave the scene,
//
//     Rgb Le(const Vec3f& w) const
//         returns the radiance that arrives from direction w (unit, world);
//     float Pdf(const Vec3f& w) const
//         returns the density, 1/sr, with which Sample finds w.
#pragma once

#include "renderer/base/visit.h"
#include "renderer/scene/lights/area.h"
#include "renderer/scene/lights/distant.h"
#include "renderer/scene/lights/goniometric.h"
#include "renderer/scene/lights/infinite.h"
#include "renderer/scene/lights/point.h"
#include "renderer/scene/lights/projection.h"
#include "renderer/scene/lights/spot.h"

namespace lull {

using Light = std::variant<PointLight, SpotLight, DistantLight, InfiniteLight, AreaLight,
                           GoniometricLight, ProjectionLight>;

inline LightType TypeOf(const Light& light) {
    return Visit(light, []<typename L>(const L&) { return L::kType; });
}

}  // namespace lull
