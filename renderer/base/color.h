// Converts between linear RGB, luminance and display values.
#pragma once

#include "renderer/base/math.h"
#include "stopping/base/block_view.h"

namespace lull {

// Returns the luminance Y of linear sRGB.
inline float Luminance(const Rgb& c) { return Luminance(c.x(), c.y(), c.z()); }

// Maps linear [0, 1] to the sRGB transfer curve (IEC 61966-2-1).
inline float SrgbFromLinear(float v) {
    return v <= 0.0031308f ? 12.92f * v : 1.055f * std::pow(v, 1 / 2.4f) - 0.055f;
}

// Inverts SrgbFromLinear.
inline float LinearFromSrgb(float v) {
    return v <= 0.04045f ? v / 12.92f : std::pow((v + 0.055f) / 1.055f, 2.4f);
}

}  // namespace lull
