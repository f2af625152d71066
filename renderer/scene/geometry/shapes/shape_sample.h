// A sampled point of an emitting shape, and conversion of densities by area to those by solid
// angle.
#pragma once

#include "renderer/base/math.h"

namespace lull {

struct ShapeSample {
    Vec3f p, pError, n;  // world; n unit, on the side that emits
    float pdf = 0;       // 1/sr, as seen from the reference point; positive and finite. Or 1/m^2
};

// Bounds normals by a cone about an axis.
struct NormalBounds {
    Vec3f axis = Vec3f::UnitZ();
    float cosAngle = -1;      // -1: any normal
    bool isTwoSided = false;  // the cone about the opposite of the axis as well
};

// Converts a density by area to one by solid angle; 0 if that would not be finite.
inline float SolidAnglePdf(float areaPdf, const Vec3f& from, const Vec3f& p, const Vec3f& n) {
    const Vec3f d = p - from;
    const float distance2 = d.squaredNorm();
    // |cos| = |n.d| / |d|, so the density is areaPdf |d|^3 / |n.d|.
    const float pdf = areaPdf * distance2 * std::sqrt(distance2) / std::abs(n.dot(d));
    return std::isfinite(pdf) ? pdf : 0;
}

}  // namespace lull
