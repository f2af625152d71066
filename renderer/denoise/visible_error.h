// Predicts how visible the error of a denoised picture is, without a reference.
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "renderer/denoise/denoise.h"
#include "renderer/vision/visible_difference.h"
#include "stopping/signals/lightness.h"

namespace lull {

// Estimates the error in lightness of a denoised picture from the halves of its samples.

// Estimates by pixel of the squared error in lightness L (0 to 100) of a picture as displayed.
struct EstimatedError {
    Planes lightness;  // of the picture
    Planes squared;    // an estimate of it without bias (see ChooseCandidates()), and very noisy
    Planes deviation;  // the standard deviation of that noise
    Planes least;      // half the difference of the denoised halves: the part that still changes
    Planes structure;  // structure of the samples that the picture lacks (denoise.h);
                       // not squared
    Halves noisy;      // luminances of the halves of the samples
};
// Measures it as it is seen (AsSeen). A crop has the same bits, but for structure, where it has a
// margin of kErrorReach pixels; `structure` is that of the picture.
inline constexpr int kErrorReach = 5;
EstimatedError MeasureError(const DenoisedPicture&, Planes structure);
EstimatedError MeasureError(const DenoisedPicture&);

// Scales coarse differences in lightness, blotches of several pixels, by the higher sensitivity of
// the eye to them. Noise without correlation between pixels keeps its strength.
Planes AsSeen(Planes difference);

// The error of a block: the mean over its 10 x 10 sub-blocks of the root mean square in lightness,
// as it is seen, times its visibility there (NoiseVisibility: flare and detail). Missing structure
// is not in it.
struct LightnessError {
    double estimate = 0;
    double upper = 0;  // not exceeded in 90 of 100 blocks
    double least = 0;  // the part that still changes; the others are not below
};

// Measures a block of at least 10 pixels a side.
LightnessError MeasureLightnessError(const EstimatedError&, const PixelRect&);

DenoisedPicture Crop(const DenoisedPicture&, const ImageTile&);

// Returns the estimated standard error of each pixel in lightness, smoothed over the pixels around,
// with that of missing structure (EstimatedError::structure) and of fireflies.
Planes StandardError(const DenoisedPicture&, const Planes& structure);

// Lightness of linear luminances as a display shows them.

// Returns the lightness L, in [0, 100], of the displayed value of a luminance, and its derivative
// by luminance, which is 0 above white.
inline LightnessSlope<float> DisplayedLightness(float y) {
    return y < 1 ? LightnessAt(y) : LightnessSlope<float>{100, 0};
}

// Shows denoised pictures as they are graded.

// Replaces linear R, G, B of pixels by those on a display, from any thread; null: they stay.
using Grading = std::function<void(std::span<float> rgb)>;

// Returns the picture as it is shown. Its halves and their samples differ from it by noise, which
// is scaled by the derivative of the grading there, which keeps estimates unbiased.
DenoisedPicture Graded(const DenoisedPicture&, const Grading&);

// The visible difference (renderer/vision/visible_difference.h) between a block of the picture and
// the true one, without the noise of its worst pixels, one of 5,000: a single rare path would
// decide for the block.
struct VisibleError {
    double estimate = 0;
    double upper = 0;  // seldom exceeded
    // How many of the worst pixels may be wrong by kNoticedError or more, and by what lightness.
    int worstPixels = 0;
    double worst = 0;
};

inline constexpr double kNoticedError = 5;  // of a pixel, in lightness

// The default of the rule `denoised`: the estimate, without the worst pixels, of accepted blocks.
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
