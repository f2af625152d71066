// Fits the colours around each pixel as a linear function of features, and lets every fit speak for
// all pixels that it was made from: first-order regression as in Bitterli et al., "Nonlinearly
// weighted first-order regression for denoising Monte Carlo renderings" (EGSR 2016).
#pragma once

#include <span>
#include <vector>

#include "renderer/denoise/patch_weights.h"

namespace lull {

inline constexpr int kFeatures = 7;  // albedo R, G, B, normal X, Y, Z, 1 / depth

// Returns for each bandwidth what the features make of `colour`. Weights are those of the guide
// (PatchWeights::Of), which is the other half of the samples, so that they do not depend on the
// noise of what is fitted. A row of fits speaks for the rows around it too: with fits in each
// second row pictures are a few per cent worse, in half of the time. All images are of one size,
// and finite. The same bits for any number of threads.
std::vector<Planes> Regress(const Planes& colour, const Planes& features, const PatchGuide&,
                            const PatchOptions&, std::span<const float> bandwidths,
                            int rowsPerFit = 1);

}  // namespace lull
