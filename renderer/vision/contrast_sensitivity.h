// The contrast that people just see: castleCSF.
#pragma once

namespace lull {

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
