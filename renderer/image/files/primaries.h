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

// Multiplies the colours of an image of three channels or more by such a matrix. Parts of them that
// Rec. 709 lacks become 0: neither lights nor surfaces have negative ones.
template <typename T>
void Convert(const Eigen::Matrix3f& matrix, size_t channels, size_t pixels, T* texels) {
    for (size_t i = 0; i < pixels; ++i) {
        T* const c = texels + i * channels;
        const Vec3f given{float(c[0]), float(c[1]), float(c[2])}, color = matrix * given;
        const float least = given.minCoeff() >= 0 ? 0 : -kInfinity;
        for (int k = 0; k < 3; ++k) c[k] = T(std::max(color[k], least));
    }
}

}  // namespace lull
