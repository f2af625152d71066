// Removes the noise of an image, and estimates the remaining error.
//
// Colours are fitted to features (regression.h) twice: each half of the samples by weights from the
// other half. Each filtered half is compared with the samples of the other, which measures blur as
// well as residual noise. With more samples, weights become so selective that the result converges
// to the mean of the samples.
#pragma once

#include "renderer/denoise/feature_filter.h"
#include "renderer/denoise/fireflies.h"
#include "renderer/denoise/planes.h"

namespace lull {

// Inputs of the denoiser. All images have one size.
struct NoisyPicture {
    Halves colour;    // R, G, B: means of two halves of the samples, independent of each other
    Planes features;  // albedo, normal and 1 / depth, as FilterFeatures() has made them
    // Variance of the luminance of the mean of all samples, from their squares; no channel where it
    // is not known: then the halves alone tell.
    Planes variance;
    // The part of `colour`, R, G, B, that comes from lamps seen directly; no channels where it is
    // not known. That of lamps of few pixels is not filtered.
    Halves emission = {};
};

struct DenoisedPicture {
    Planes picture;   // R, G, B; finite and not negative
    Halves halves;    // each half denoised; their mean is the picture without fireflies
    Halves noisy;     // the halves of the samples without fireflies, which judge them
    Planes variance;  // of a pixel of these, R, G, B
    Planes returned;  // the standard deviation of the fireflies' light in the picture, luminance
    std::vector<Firefly> fireflies;  // what was taken from the samples; Crop() leaves it out
};

// Estimates the variance of a pixel of either half, R, G, B, > 0, from that of the mean (see
// NoisyPicture), if it is known, and the difference of the halves, whose values are as Sane() has
// them.
Planes EstimateVariance(const Halves& colour, const Planes& ofMean);

// Lowers the variance of the mean, where it is known, of pixels from which fireflies were taken to
// that of the halves without them. A single rare path would hide the error of all pixels around.
void ForgetFireflies(const std::vector<Firefly>&, const Halves& without, Planes* ofMean);

// Denoises a picture of at least one pixel, whose memory it uses. Values that are not finite or
// negative count as 0. The same bits for any number of threads. Takes some 7.5 us of
// CPU time a pixel, or 5.5 if it is quick.
DenoisedPicture Denoise(NoisyPicture, Effort = Effort::Full, const ShareListener& = {});

// Shows pictures at half of their size, where noise is less and neighbourhoods are wider.

// Returns the means of 2 x 2 pixels each; at an odd border, of those that are there.
Planes Halved(const Planes&);

// Returns an image of this size, half of which, rounded up, the given one has.
Planes Doubled(const Planes&, int width, int height);

// Returns `fine` with its coarse part, Halved(fine), replaced by `coarse`.
Planes WithCoarsePart(Planes fine, const Planes& coarse);

}  // namespace lull
