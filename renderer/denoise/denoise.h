// Takes the noise out of a picture, and says how wrong it may still be.
//
// Colours are fitted to features (regression.h) twice: those of one half of the samples by weights
// that the other half gives, and the other way round. So each half can judge what was made of the
// other, and the judgement sees what is blurred as well as what is left of the noise. As the
// samples grow, weights become so selective that the result goes to the mean of the samples.
#pragma once

#include "renderer/denoise/feature_filter.h"

namespace lull {

// Holds what is known of a picture. All images have one size.
struct NoisyPicture {
    Halves colour;    // R, G, B: means of two halves of the samples, independent of each other
    Planes features;  // albedo, normal and 1 / depth, as FilterFeatures() has made them
    // Variance of the luminance of the mean of all samples, from their squares; no channel where it
    // is not known: then the halves alone tell.
    Planes variance;
};

struct DenoisedPicture {
    Planes picture;   // R, G, B; finite and not negative
    Halves halves;    // what was made of either half; their mean is the picture without fireflies
    Halves noisy;     // the halves of the samples without fireflies, which judge them
    Planes variance;  // of a pixel of these, R, G, B
};

// Denoises a picture of at least one pixel, whose memory it uses. Values that are not finite or
// negative count as 0. The same bits for any number of threads. Takes some 7.5 us of
// CPU time a pixel, or 5.5 with 2 rows a fit (see RegressionInput).
DenoisedPicture Denoise(NoisyPicture, int rowsPerFit = 1);

}  // namespace lull
