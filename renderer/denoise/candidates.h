// Chooses, place by place, which of several pictures is nearest to the truth.
#pragma once

#include <vector>

#include "renderer/denoise/planes.h"

namespace lull {

inline constexpr int kChoiceReach = 11;  // pixels, from which a choice depends on others

// Returns for each half a mixture of the candidates, R, G, B; the last of them are the samples as
// they are, `noisy`, whose pixels have this variance. The squared error of a candidate is that of
// what was made of the other half against the samples of this one, less what the noise of these
// explains: without bias, but noisy, so that it is averaged over some pixels, those with least
// noise counting most. The half that judges the result (visible_error.h) so has no part in the
// choice, which would look better to it than it is. The samples themselves are chosen only where
// all others are worse beyond doubt.
Halves ChooseCandidates(std::vector<Halves> candidates, const Halves& noisy,
                        const Planes& variance);

}  // namespace lull
