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

// The contrast that people just see: castleCSF.

enum class OpponentChannel { Achromatic, RedGreen, YellowViolet };
inline constexpr int kOpponentChannels = 3;

// A still Gabor patch on a background of daylight (D65), looked at directly.
struct GaborPatch {
    double frequency = 1;    // cycles per degree, > 0
    double area = 1;         // square degrees, pi times the square of the envelope's deviation, > 0
    double luminance = 100;  // of the background, cd/m2, > 0
};

// Returns 1 / contrast at the threshold of a patch that is modulated along one opponent
// direction; the contrast is the channel's amplitude over the luminance of the
// background. Ashraf, Mantiuk, Chapiro, Wuerger: castleCSF - A contrast sensitivity function of
// color, area, spatiotemporal frequency, luminance and eccentricity, Journal of Vision 24(4), 2024,
// with the parameters of its implementation, version 0.2.4, at 0 Hz and no eccentricity. The
// transient mechanism is left out: it adds less than 1e-4 of it to still patches from 0.1 cd/m2 on.
double ContrastSensitivity(OpponentChannel, const GaborPatch&);

}  // namespace lull
