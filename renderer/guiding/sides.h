// Tells apart the sides of surfaces that what is learned of a place is kept for.
#pragma once

#include "renderer/base/math.h"

namespace lull {

// The axis that a normal is closest to, -x, +x, -y, ...; and points in media.
inline constexpr int kSides = 7, kInMedium = 6;

inline int SideOf(const Vec3f& n) {
    int axis;
    n.cwiseAbs().maxCoeff(&axis);
    return 2 * axis + (n[axis] > 0);
}

}  // namespace lull
