// Filters noisy colours: fits in windows of some pixels (regression.h), the choice among them
// (candidates.h), and the same at half of the size for wider structure (scales.h).
#pragma once

#include <functional>

#include "renderer/denoise/planes.h"

namespace lull {

// What a denoised picture may cost.
enum class Effort {
    Full,
    Quick  // a little worse, in 60 % of the time: for a look at how far a render is
};

// Called with the share of the work that is done, in [0, 1] and never less than before, on the
// thread that waits for the result; may be empty.
using ShareListener = std::function<void(double share)>;

// Returns both halves of the samples, R, G, B, filtered. `variance` is of a pixel of either.
// Processes bands of rows, so that the candidates of few rows are in memory at a time, and the
// result takes the place of the features. The same bits for any number of threads.
Halves FilterColours(const Halves& noisy, Planes features, const Planes& variance, Effort,
                     const ShareListener& onShare = {});

}  // namespace lull
