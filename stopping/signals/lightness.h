// Converts linear radiance to the colours of a display: 8-bit sRGB, and its lightness.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "stopping/base/block_view.h"

namespace lull {

// Clamps a linear component to the range of a display, [0, 1]; 0 for NaN.
inline float Displayed(float x) { return x > 0 ? std::min(x, 1.f) : 0; }

// Returns the linear value of a component in [0, 1] that follows the sRGB transfer curve.
double DecodeSrgb(double v);

// Returns the same of all 8-bit components.
const std::array<double, 256>& DecodeSrgb8();

// Applies the sRGB transfer curve (IEC 61966-2-1) to linear values, clamps to [0, 1] and rounds
// to 8 bits. NaN becomes 0. Throws std::invalid_argument if the lengths differ.
void EncodeSrgb8(std::span<const float> linear, std::span<uint8_t> srgb);

// Computes the CIE 1976 lightness, in [0, 100], of pixels in 8-bit sRGB (row-major R, G, B):
// L = 116 f(Y) - 16 with f(t) = cbrt(t) where t > kLinearLuminance and 7.787 t + 16/116 elsewhere.
// Throws std::invalid_argument if `srgb` is not three times as long as `lightness`.
void Lightness(std::span<const uint8_t> srgb, std::span<double> lightness);

// Returns the lightness of linear pixels (R, G, B) as an 8-bit display shows them.
std::vector<double> LightnessOf(std::span<const float> linear);

// The luminance below which L is linear in it.
inline constexpr double kLinearLuminance = 0.008856;

// L at a luminance, at least 0, and its derivative there; above white L continues.
template <typename Real>
struct LightnessSlope {
    Real lightness, slope;
};
template <typename Real>
LightnessSlope<Real> LightnessAt(Real y) {
    if (!(y > Real(kLinearLuminance)))
        return {std::max(Real(0), 116 * (Real(7.787) * y + 16 / Real(116)) - 16),
                116 * Real(7.787)};
    const Real root = std::cbrt(y);
    return {116 * root - 16, 116 / (3 * root * root)};
}

// Returns the luminance, at least 0, that has this L.
double LuminanceOf(double lightness);

// Tells linear pictures, in which 1 is the display's white, from others.

// Counts the pixels of a picture by their values.
struct PictureValues {
    size_t pixels = 0;
    size_t notFinite = 0;  // a value of R, G, B is infinite or not a number
    size_t negative = 0;   // of a luminance below 0
    size_t lit = 0;        // of a luminance above 0
    size_t bright = 0;     // of a luminance above 4

    void Add(float r, float g, float b);
    void Add(const PictureValues&);
};

// Return the fault of a picture, or "": of its values, where more than a tenth of the pixels are
// not finite, or more than a quarter negative; of its exposure, where more than half of the lit
// pixels are brighter than four times white, as in pictures of 0 to 255. The exposure of a part of
// a picture is no fault: a block may show no more than a window.
std::string FaultOfValues(const PictureValues&);
std::string FaultOfExposure(const PictureValues&);

}  // namespace lull
