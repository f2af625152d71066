// Shows pictures at half of their size, where noise is less and neighbourhoods are wider.
#pragma once

#include "renderer/denoise/planes.h"

namespace lull {

// Returns the means of 2 x 2 pixels each; at an odd border, of those that are there.
Planes Halved(const Planes&);

// Returns an image of this size, half of which, rounded up, the given one has.
Planes Doubled(const Planes&, int width, int height);

// Returns `fine` with its coarse part, Halved(fine), replaced by `coarse`.
Planes WithCoarsePart(Planes fine, const Planes& coarse);

}  // namespace lull
