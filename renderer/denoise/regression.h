// Fits the colours around each pixel as a linear function of features, and lets every fit speak for
// all pixels that it was made from: first-order regression as in Bitterli et al., "Nonlinearly
// weighted first-order regression for denoising Monte Carlo renderings" (EGSR 2016).
#pragma once

#include <span>
#include <vector>

#include "renderer/denoise/feature_filter.h"
#include "renderer/denoise/patch_weights.h"

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

}  // namespace lull
