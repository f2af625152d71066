// Takes the noise out of features before colours are fitted to them.
#pragma once

#include "renderer/denoise/planes.h"

namespace lull {

// Returns the mean of both halves, each filtered by non-local means with the weights that the other
// half has. Noise comes from lenses, motion and glossy ways; where there is none, nothing is
// changed. Both have the same size and channels, and are finite.
Planes FilterFeatures(const Planes& a, const Planes& b);

}  // namespace lull
