// Predicts how visible the error of a denoised picture is, without a reference.
#pragma once

#include "renderer/denoise/lightness_error.h"
#include "renderer/vision/display_model.h"

namespace lull {

// The visible difference (renderer/vision/visible_difference.h) between a block of the picture and
// the true one, without the noise of its worst pixels, one of 5,000: a single rare path would
// decide for the block.
struct VisibleError {
    double estimate = 0;
    double upper = 0;  // seldom exceeded
    // How many of the worst pixels may be wrong by kNoticedError or more, and by how much at most,
    // in lightness.
    int worstPixels = 0;
    double worst = 0;
};

inline constexpr double kNoticedError = 5;  // of a pixel, in lightness

// The upper bound, without the worst pixels, below which a block is accepted: the default of the
// rule `denoised`.
inline constexpr double kAcceptedBound = 3.1;

// Measures a block of at least 10 pixels a side. Half the difference of the denoised halves has the
// pattern of the error; it is scaled to the error in lightness (MeasureLightnessError). Structure
// that is missing is added to it, and fireflies' light is taken off by its standard deviation.
VisibleError MeasureVisibleError(const DenoisedPicture&, EstimatedError, const PixelRect&,
                                 const DisplayModel& = {});

}  // namespace lull
