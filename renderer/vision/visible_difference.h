// Predicts where a person sees that two still pictures differ, from published vision science.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "renderer/base/math.h"
#include "renderer/vision/display_model.h"
#include "renderer/vision/image_pyramid.h"

namespace lull {

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

// A reference as it is compared with pictures, from fine to coarse: contrast and sensitivity by
// channel, at each place of a band.
struct ReferenceBand {
    double frequency = 0;  // cycles per degree
    std::array<Plane, kOpponentChannels> contrast, sensitivity;
};
struct VisibleReference {
    int width = 0, height = 0;
    DisplayModel display;
    std::vector<ReferenceBand> bands;
};

// Prepares a picture of linear RGB (row-major triples) on a display. Throws Error if sizes do not
// fit.
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
