// Says how large the error is that people can see in a denoised picture, without a reference.
#pragma once

#include "renderer/denoise/denoise.h"

namespace lull {

// Holds what is known, pixel by pixel, of the squared error in lightness L (0 to 100) of a denoised
// picture as a display shows it.
struct EstimatedError {
    Planes lightness;  // of the picture
    Planes squared;    // an estimate of it without bias (see candidates.h), and very noisy
    Planes deviation;  // the standard deviation of that noise
    Planes least;      // what the halves of the denoised picture differ by: what still changes
    Planes structure;  // what the samples have beyond doubt and the picture has not (structure.h)
};
// Measures it as it is seen (AsSeen).
EstimatedError MeasureError(const DenoisedPicture&);

// Makes what is coarse in differences in lightness, blotches of several pixels, as much stronger as
// the eye is more sensitive to it. Noise without correlation between pixels stays as strong.
Planes AsSeen(Planes difference);

// Holds the visible error of a block: the mean over its 10 x 10 sub-blocks of the root mean square
// of the error in lightness, as it is seen, times what an observer sees of a difference there
// (NoiseVisibility: flare and detail). Structure that is missing counts by the fourth root of the
// mean of its fourth power, if that is more, so that a line of which a block has little counts.
struct VisibleError {
    double estimate = 0;
    double upper = 0;  // not exceeded in 95 of 100 blocks
    double least = 0;  // what of it still changes; the others are not below
};

// Measures the pixels [x0, x1) x [y0, y1), at least 10 a side.
VisibleError MeasureVisibleError(const EstimatedError&, int x0, int y0, int x1, int y1);

// Returns the estimated standard error of each pixel in lightness, smoothed over the pixels around,
// with what is missing of structure (EstimatedError::structure).
Planes StandardError(const DenoisedPicture&, const Planes& structure);

}  // namespace lull
