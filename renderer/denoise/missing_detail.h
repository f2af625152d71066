// Finds detail that a denoised picture lacks, by band of spatial frequency.
#pragma once

#include "renderer/denoise/planes.h"

namespace lull {

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

}  // namespace lull
