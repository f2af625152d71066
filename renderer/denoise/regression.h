// Fits the colours around each pixel as a linear function of features, and lets every fit speak for
// all pixels that it was made from: first-order regression as in Bitterli et al., "Nonlinearly
// weighted first-order regression for denoising Monte Carlo renderings" (EGSR 2016).
#pragma once

#include <span>
#include <vector>

#include "renderer/denoise/feature_filter.h"
#include "renderer/denoise/patch_weights.h"

namespace lull {

// Holds what is fitted, and how. All images are of one size, and finite.
struct RegressionInput {
    const Planes& colour;
    const Planes& features;
    // Weights are those of the guide (PatchWeights::Of), which is the other half of the samples, so
    // that they do not depend on the noise of what is fitted.
    PatchGuide guide;
    PatchOptions patches;
    std::span<const float> bandwidths;
    // A row of fits speaks for the rows around it too: with fits in each second row pictures are a
    // few per cent worse, in half of the time.
    int rowsPerFit = 1;
};

// Returns for each bandwidth what the features make of the colours of a tile, which lies within the
// image.
std::vector<Planes> RegressTile(const RegressionInput&, const ImageTile&);

}  // namespace lull
