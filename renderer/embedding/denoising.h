// Denoises pictures that other programs show.
#pragma once

#include "lull/lull.h"

namespace lull {

// Throws std::invalid_argument, with nothing written, for pictures and outputs that lull/lull.h
// does not allow.
void Denoise(const lull_noisy_picture& noisy, lull_denoised_picture* clean);

}  // namespace lull
