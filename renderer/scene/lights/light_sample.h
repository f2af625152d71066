// Types of all kinds of light: their traits, and samples of their light.
#pragma once

#include "renderer/base/math.h"

namespace lull {

// Tells lights apart by how paths find them. Rays meet none of the delta lights.
enum class LightType { DeltaPosition, DeltaDirection, Area, Infinite };

constexpr bool IsDelta(LightType type) {
    return type == LightType::DeltaPosition || type == LightType::DeltaDirection;
}

// Light that may arrive at a point.
struct LightSample {
    Rgb L;          // radiance arriving, or for delta lights radiant intensity / distance^2
    Vec3f wi;       // towards the light, unit, world
    float pdf;      // 1/sr; 1 for delta lights
    bool isDelta;   // no other strategy can find this direction
    bool isHidden;  // the emitter is invisible to rays; only light sampling finds it
    // L is 1, and the map's radiance is left to LightTable::Radiance(): where the light is
    // occluded, it is not needed.
    bool isOnMap = false;
    // The point on the light; n is zero for point lights. A light at infinity has no point, but for
    // that on its map: (s, t, 0).
    bool isAtInfinity = false;
    Vec3f p = Vec3f::Zero(), pError = Vec3f::Zero(), n = Vec3f::Zero();
};

// Light that a ray finds.
struct Emitted {
    Rgb L;      // radiance
    float pdf;  // 1/sr, with which sampling the light finds the same direction
};

}  // namespace lull
