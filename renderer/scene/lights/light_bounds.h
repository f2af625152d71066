// Bounds where lights sit, where they shine and how much, for one light or for many together.
#pragma once

#include "renderer/base/color.h"

namespace lull {

// Follows Conty Estevez and Kulla 2018 (section 4.1): light leaves at angles of up to theta_e from
// normals that lie within theta_o of an axis.
struct LightBounds {
    Bounds3f box{};  // world
    Vec3f axis = Vec3f::UnitZ();
    float cosNormals = 1;   // cos(theta_o)
    float cosEmission = 0;  // cos(theta_e)
    float power = 0;        // luminance, W; nonnegative and finite, 0 for a light that is black
    bool isTwoSided = false;
};

// Returns the value that LightBounds has for a light of this power: positive unless the light is
// black, and small enough that float can hold sums over many lights.
inline float BoundedPower(const Rgb& power) {
    constexpr float kLeast = 1e-30f, kMost = 1e27f;
    const float luminance = Luminance(power.abs());
    return std::isnan(luminance) || luminance == 0 ? 0 : std::clamp(luminance, kLeast, kMost);
}

}  // namespace lull
