// Sides of surfaces, each of which is learned by itself.
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
