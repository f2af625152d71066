// Fits the colours around each pixel as a linear function of features, and lets every fit speak for
// all pixels that it was made from: first-order regression as in Bitterli et al., "Nonlinearly
// weighted first-order regression for denoising Monte Carlo renderings" (EGSR 2016).
#pragma once

#include <span>
#include <vector>

#include "renderer/denoise/feature_filter.h"
#include "renderer/denoise/patch_weights.h"
#include "renderer/denoise/planes.h"

namespace lull {

// Image to fit, its features and options. All images are of one size, and finite.
struct RegressionInput {
    const Planes& colour;
    const Planes& features;
    // The other half of the samples, from which weights come (PatchWeights::Of), so that they do
    // not depend on the noise of `colour`.
    PatchGuide guide;
    PatchOptions patches;
    std::span<const float> bandwidths;
    // A row of fits speaks for the rows around it too: with fits in each second row pictures are a
    // few per cent worse, in half of the time.
    int rowsPerFit = 1;
};

// Returns for each bandwidth the fit of the colours of a tile, which lies within the image, to its
// features.
std::vector<Planes> RegressTile(const RegressionInput&, const ImageTile&);

// Chooses, place by place, which of several pictures is nearest to the truth.

inline constexpr int kChoiceReach = 11;  // pixels, from which a choice depends on others

// Returns for each half a mixture of the candidates, R, G, B; the last of them are the unfiltered
// samples, `noisy`, with this variance of a pixel. The squared error of a candidate is that of the
// other half, filtered, against the samples of this one, less the part explained by their noise:
// unbiased, but noisy, so that it is averaged over some pixels, weighted by inverse noise. The
// half that judges the result (visible_error.h) so has no part in the choice, which would
// underestimate the error. The samples themselves are chosen only where all others are worse
// beyond chance.
Halves ChooseCandidates(std::vector<Halves> candidates, const Halves& noisy,
                        const Planes& variance);

}  // namespace lull
