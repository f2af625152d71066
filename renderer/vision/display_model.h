// Describes the display on which a picture is looked at, and from how far.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lull {

struct DisplayModel {
    double peak = 100;            // cd/m2, of white
    double pixelsPerDegree = 40;  // of vision
    double ambient = 250;         // lux that fall onto the screen
    double contrast = 1000;       // white to black in a dark room
    double reflectance = 0.005;   // of the screen
};

// Reads "100cd,40ppd" or "100cd,40ppd,250lux", in any order; missing parts keep their defaults.
// Peak luminance from 1 to 10,000 cd/m2, 5 to 500 pixels a degree, at most 100,000 lux. Throws
// Error.
DisplayModel ParseDisplay(std::string_view text);

// Returns a text that ParseDisplay() reads as the same display.
std::string NameOf(const DisplayModel&);

// Returns the light that reaches the eye from each pixel, in cd/m2 by linear component, so that
// equal components are white: the emission of the pixels, clamped to the range of the display, plus
// its black level and reflections (Mantiuk, Myszkowski, Seidel: High Dynamic Range Imaging, 2015).
// NaN is black.
std::vector<float> DisplayedLight(std::span<const float> linear, const DisplayModel&);

}  // namespace lull
