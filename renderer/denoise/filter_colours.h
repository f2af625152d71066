// Filters noisy colours: fits in windows of some pixels (regression.h), the choice among them
// (candidates.h), and the same at half of the size for wider structure (scales.h).
#pragma once

#include "renderer/denoise/planes.h"

namespace lull {

// Returns both halves of the samples, R, G, B, filtered. `variance` is of a pixel of either.
// Processes bands of rows, so that the candidates of few rows are in memory at a time. The same
// bits for any number of threads.
Halves FilterColours(const Halves& noisy, const Planes& features, const Planes& variance,
                     int rowsPerFit);

}  // namespace lull
