// Converts linear colours of other primaries.
#pragma once

#include "renderer/base/math.h"

namespace lull {

// Chromaticities x and y (CIE 1931) of linear R, G, B and of white, their sum.
struct Primaries {
    Vec2f red, green, blue, white;
};

// Returns the matrix that makes such colours those of Rec. 709, with white adapted to D65 as
// Bradford's. Not finite where the primaries are none.
Eigen::Matrix3f Rec709From(const Primaries& primaries);

}  // namespace lull
