// Finds structure in the residual of a filter, the samples less the picture, which should be noise.
//
// The residual in lightness is summed over squares of 3 and 9 pixels a side and, in 12 directions,
// lines of 11 pixels and bars of 3 x 15 pixels around each pixel. A sum is structure where it is
// more than 4.5 times as large as its standard deviation: by the variance of its pixels, by the
// difference of the halves in them, or by that in the 7 x 7 pixels around each, whichever is
// largest. So neither fireflies nor the gaps between them nor variances that are too small are
// taken for structure.
#pragma once

#include "renderer/denoise/planes.h"

namespace lull {

inline constexpr int kStructureReach = 10;  // pixels, from which what is found in one depends

// Adds to the middle of each square, line and bar the mean of its residual where that is structure,
// round by round. Each half gets the mean of its own samples, and stays within their range
// (fireflies.h). `variance` is of a pixel of either half. The same bits for any number of
// threads.
void RestoreStructure(const Halves& noisy, const Planes& variance, Halves* picture);

// Returns that mean in lightness, which the picture lacks, where it is structure; elsewhere 0.
// Where that is uncertain, its square counts in part.
Planes StructureLeft(const Halves& noisy, const Planes& variance, const Halves& picture);

}  // namespace lull
