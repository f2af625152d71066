// Takes the noise out of features before colours are fitted to them.
#pragma once

#include <functional>

#include "renderer/denoise/planes.h"

namespace lull {

inline constexpr int kFeatures = 7;  // albedo R, G, B, normal X, Y, Z, 1 / depth

// Returns the feature of a depth: its reciprocal, and 0 where there is nothing.
inline float DisparityOf(float depth) { return depth > 0 ? 1 / std::max(depth, 1e-12f) : 0; }

// Returns the rows [y0, y1) of kFeatures means of both halves of the samples. So that these, which
// are large, need not be in memory a second time, they are asked for rows as they are needed.
using FeatureReader = std::function<Halves(int y0, int y1)>;

// Returns the mean of both halves, each filtered by non-local means with weights from the other
// half, and scaled to [-1, 1]. Noise comes from lenses, motion and glossy paths; without noise,
// nothing is changed. NaN counts as 0. Calls forget(end), if there is such, when the rows above
// `end` will not be read again.
Planes FilterFeatures(int width, int height, const FeatureReader&,
                      const std::function<void(int end)>& forget = {});

// Filters noisy colours: fits in windows of some pixels (regression.h), the choice among them
// (regression.h), and the same at half of the size for wider structure (denoise.h).

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
