// Predicts where a person sees that two still pictures differ, from published vision science.
#pragma once

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "renderer/base/math.h"

namespace lull {

// Describes the display on which a picture is looked at, and from how far.

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

// Halves and doubles images, as a Laplacian pyramid needs it.

// Filters images with small separable kernels.

// Returns the image, `width` x `height` values row by row, filtered by `alongX` in its rows and
// `alongY` in its columns; both have an odd length and are centred. Beyond the border the border
// pixels are repeated. As a correlation: alongX[0] weights the leftmost neighbour.
std::vector<float> Convolve(std::span<const float> image, int width, int height,
                            std::span<const double> alongX, std::span<const double> alongY);

// Returns exp(-x^2 / (2 sigma^2)) at x = -radius ... radius, divided by the sum.
std::vector<double> GaussianKernel(double sigma, int radius);

// A value at each pixel, row by row.
struct Plane {
    int width = 0, height = 0;
    std::vector<float> values;
};

// Returns the image at half the resolution, rounded up, with the kernel (1, 5, 8, 5, 1) / 20 and
// its border mirrored: Burt, Adelson: The Laplacian Pyramid as a Compact Image Code, IEEE
// Transactions on Communications 31(4), 1983, with a = 0.4. Pixel (x, y) is centred where pixel
// (2 x, 2 y) was.
Plane Reduce(const Plane&);

// Interpolates to `width` x `height`, where the image has the size of Reduce() of such a one.
Plane Expand(const Plane&, int width, int height);

// How visible the difference is in one band of spatial frequencies: for each opponent channel
// a value at each place, 0 where there is none and about 1 where a pattern is just seen. The
// planes are Reduce()d `level` times.
struct VisibleBand {
    double frequency = 0;  // cycles per degree
    int level = 0;
    std::array<Plane, kOpponentChannels> difference;
};

// From fine to coarse; the last band is the residual of the pyramid.
struct VisibleDifference {
    int width = 0, height = 0;  // of the pictures
    std::vector<VisibleBand> bands;
};

// A reference, from fine to coarse: contrast and sensitivity by channel, at each place of a band.
struct ReferenceBand {
    double frequency = 0;  // cycles per degree
    std::array<Plane, kOpponentChannels> contrast, sensitivity;
};
struct VisibleReference {
    int width = 0, height = 0;
    DisplayModel display;
    std::vector<ReferenceBand> bands;
};

// Prepares linear RGB (row-major triples) on a display. Throws Error if sizes do not fit.
VisibleReference PrepareReference(std::span<const float> reference, int width, int height,
                                  const DisplayModel&);

// Compares two pictures of linear RGB (row-major triples), as ColorVideoVDP compares still ones:
// Mantiuk, Hanji, Ashraf, Asano, Chapiro: ColorVideoVDP: A visual difference predictor for image,
// video and display distortions, ACM TOG 43(4), 2024, with the constants of its version 0.5.6.
// Sensitivity is castleCSF's own. The pictures are seen on a display; values are clamped
// to its range, and NaN is black. Throws Error if sizes do not fit.
VisibleDifference FindVisibleDifference(std::span<const float> image,
                                        std::span<const float> reference, int width, int height,
                                        const DisplayModel&);
VisibleDifference FindVisibleDifference(std::span<const float> image, const VisibleReference&);

// Visible difference of all pixels of a block above which it differs visibly. The one number that
// agrees best with the human thresholds of 102 blocks is 3.45 (95 %: 2.0 to 5.1;
// docs/denoising.md).
inline constexpr double kVisibilityThreshold = 3.1;

// Returns the visible difference of a part of the picture, in pixels; not empty. This is the
// paper's Q: 0 where both are the same; a grating at threshold has 0.2 to 2.
double PooledDifference(const VisibleDifference&, const PixelRect&);
double PooledDifference(const VisibleDifference&);

// Returns the visible difference at each pixel, in units of PooledDifference().
std::vector<float> VisibleMap(const VisibleDifference&);

}  // namespace lull
