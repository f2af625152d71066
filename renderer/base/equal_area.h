// Maps the sphere to the unit square so that equal areas stay equal: an octahedron whose lower
// faces are folded outwards (Clarberg 2008, "Fast Equal-Area Mapping of the (Hemi)Sphere using
// SIMD"), in the orientation of pbrt-v4: +z in the middle, -z in the corners.
#pragma once

#include "renderer/base/math.h"

namespace lull {

// Returns the direction of a point of the unit square; unit.
inline Vec3f DirectionOfEqualAreaSquare(const Vec2f& p) {
    const float u = 2 * p.x() - 1, v = 2 * p.y() - 1;
    const float signedDistance = 1 - (std::abs(u) + std::abs(v));
    const float r = 1 - std::abs(signedDistance);
    const float phi = (r == 0 ? 1 : (std::abs(v) - std::abs(u)) / r + 1) * (kPi / 4);
    const float z = std::copysign(1 - Sqr(r), signedDistance);
    const float across = r * SafeSqrt(2 - Sqr(r));
    return {std::copysign(std::cos(phi) * across, u), std::copysign(std::sin(phi) * across, v), z};
}

// Returns the point of the unit square of a unit direction.
inline Vec2f EqualAreaSquareOf(const Vec3f& w) {
    const float x = std::abs(w.x()), y = std::abs(w.y());
    const float r = SafeSqrt(1 - std::abs(w.z()));
    float v = r * (std::max(x, y) > 0 ? std::atan2(y, x) : 0) * (2 / kPi), u = r - v;
    if (w.z() < 0) {
        std::swap(u, v);
        u = 1 - u;
        v = 1 - v;
    }
    return {0.5f * (std::copysign(u, w.x()) + 1), 0.5f * (std::copysign(v, w.y()) + 1)};
}

}  // namespace lull
