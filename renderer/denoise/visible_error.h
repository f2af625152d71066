// Predicts how visible the error of a denoised picture is, without a reference.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "renderer/denoise/lightness_error.h"
#include "renderer/denoise/planes.h"
#include "renderer/vision/display_model.h"
#include "renderer/vision/visible_difference.h"

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

// The estimate, without the worst pixels, below which a block is accepted: the default of the rule
// `denoised`.
inline constexpr double kAcceptedDifference = 3.1;

// Measures a block of at least 10 pixels a side. Half the difference of the denoised halves has the
// pattern of the error; it is scaled to the error in lightness (MeasureLightnessError). Structure
// that is missing is added to it, and fireflies' light is taken off by its standard deviation.
VisibleError MeasureVisibleError(const DenoisedPicture&, EstimatedError, const PixelRect&,
                                 const DisplayModel& = {});

// Finds detail that a denoised picture lacks, by band of spatial frequency.

// Differences of the luminances of the halves of a block, times a slope: denoised halves and halves
// of the samples, each of the other samples.
struct CrossedResiduals {
    Planes a, b;   // denoised half A less the samples of B, and the other way round
    Planes noise;  // the samples of A less the samples of B
    Planes half;   // half the difference of the denoised halves
};

// Returns a pattern of the detail that was removed with the noise. In each band of a Laplacian
// pyramid, crossed residuals estimate the squared error without bias. As far as it exceeds
// `ratio` times `half`, squared, by more than chance, the residual of that band, scaled to this
// excess, is part of the pattern.
Planes MissingDetail(const CrossedResiduals&, float ratio);

// Finds the few pixels of a picture that are seen to be wrong most.

// Returns the pixels of a difference, one of 5,000, that are seen most; each counts by the visible
// difference there, which its neighbours have too, times its own difference in lightness.
std::vector<size_t> WorstPixels(const VisibleDifference&, std::span<const float> lightness);

}  // namespace lull
