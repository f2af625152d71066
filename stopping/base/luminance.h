// Weighs linear R, G and B (Rec. 709 primaries) in the luminance Y, with pbrt-v3's weights.
#pragma once

namespace lull {

// They add up to 1, the luminance of white.
inline constexpr double kLuminanceWeights[3] = {0.212671, 0.715160, 0.072169};

inline float Luminance(float r, float g, float b) {
    return float(kLuminanceWeights[0]) * r + float(kLuminanceWeights[1]) * g +
           float(kLuminanceWeights[2]) * b;
}

}  // namespace lull
