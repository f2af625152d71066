// All kinds of light, and the functions of each.
//
// A kind is a struct L, in a file of lights/, with
//
//     static constexpr LightType kType
//     std::optional<LightSample> Sample(const Vec3f& from, const Vec2f& u) const
//         returns light that may arrive at `from`, nothing where none does;
//     Rgb Power() const
//         returns W; of lights without a place, the power across the disk of the scene's radius,
//
// where it has a place, and shines otherwise than a point to all sides,
//
//     LightBounds Bounds() const
//         returns where it is and where it shines,
//
// one of type Area, on which rays end,
//
//     Rgb Le(const Vec3f& n, const Vec3f& w, const Hit&) const
//         returns the radiance that leaves a hit with normal n towards w;
//     float Pdf(const Vec3f& from, const Vec3f& p, const Vec3f& n) const
//         returns the density, 1/sr, with which Sample finds the point p with normal n
//     bool isHidden
//         whether rays pass it by all the same,
//
// and one of type Infinite, which rays reach when they leave the scene,
//
//     Emitted LeAndPdf(const Vec3f& from, const Vec3f& w) const
//         returns the radiance that arrives at `from` from direction w (unit, world), and the
//         density, 1/sr, with which Sample finds w.
//
// Light that leaves a light, for paths that start there, is sampled in light_emission.cpp: by type,
// of one with a place (DeltaPosition) by its point `Vec3f p` and the cone of directions that it
// shines into, which ConeOf() returns there.
#pragma once

#include "renderer/base/variant.h"
#include "renderer/scene/lights/infinite.h"
#include "renderer/scene/lights/point.h"

namespace lull {

using Light = std::variant<PointLight, SpotLight, DistantLight, InfiniteLight, AreaLight,
                           GoniometricLight, ProjectionLight, SunLight>;

inline LightType TypeOf(const Light& light) {
    return Visit(light, []<typename L>(const L&) { return L::kType; });
}

inline bool IsVisible(const Light& light) {
    const AreaLight* area = std::get_if<AreaLight>(&light);
    return area ? !area->isHidden : TypeOf(light) == LightType::Infinite;
}

// The functions of kinds of type Area; those of other types give none and are not found.
inline Rgb Le(const Light& light, const Vec3f& n, const Vec3f& w, const Hit& hit) {
    return Visit(light, [&]<typename L>(const L& l) -> Rgb {
        if constexpr (L::kType == LightType::Area) return l.Le(n, w, hit);
        return Rgb::Zero();
    });
}
inline float Pdf(const Light& light, const Vec3f& from, const Vec3f& p, const Vec3f& n) {
    return Visit(light, [&]<typename L>(const L& l) -> float {
        if constexpr (L::kType == LightType::Area) return l.Pdf(from, p, n);
        return 0;
    });
}

// The function of kinds of type Infinite.
inline Emitted LeAndPdf(const Light& light, const Vec3f& from, const Vec3f& w) {
    return Visit(light, [&]<typename L>(const L& l) -> Emitted {
        if constexpr (L::kType == LightType::Infinite) return l.LeAndPdf(from, w);
        return {Rgb::Zero(), 0};
    });
}

}  // namespace lull
