// Chooses, place by place, which of several pictures is nearest to the truth.
#pragma once

#include <vector>

#include "renderer/denoise/planes.h"

namespace lull {

// Holds two pictures of the same, each made from one half of the samples.
struct Halves {
    Planes a, b;
};

// Returns a mixture of the candidates, R, G, B, the same for both halves; the last of them are the
// samples as they are, `noisy`, whose pixels have this variance. The squared error of a candidate
// is that of each half against the samples of the other, less what the noise of these explains
// (and less what the halves lose by being averaged): unbiased, but noisy, so that it is averaged
// over some pixels, those with least noise counting most. The samples themselves are chosen only
// where all others are worse beyond doubt.
Halves ChooseCandidates(std::vector<Halves> candidates, const Halves& noisy,
                        const Planes& variance);

}  // namespace lull
