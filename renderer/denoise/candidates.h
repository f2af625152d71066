// Chooses, place by place, which of several pictures is nearest to the truth.
#pragma once

#include <vector>

#include "renderer/denoise/planes.h"

namespace lull {

inline constexpr int kChoiceReach = 11;  // pixels, from which a choice depends on others

// Returns for each half a mixture of the candidates, R, G, B; the last of them are the unfiltered
// samples, `noisy`, with this variance of a pixel. The squared error of a candidate is that of the
// other half, filtered, against the samples of this one, less the part explained by their noise:
// unbiased, but noisy, so that it is averaged over some pixels, weighted by inverse noise. The
// half that judges the result (visible_error.h) so has no part in the choice, which would
// underestimate the error. The samples themselves are chosen only where all others are worse
// beyond chance.
Halves ChooseCandidates(std::vector<Halves> candidates, const Halves& noisy,
                        const Planes& variance);

}  // namespace lull
