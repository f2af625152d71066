// Shows denoised pictures as they are graded.
#pragma once

#include <functional>
#include <span>

#include "renderer/denoise/denoise.h"

namespace lull {

// Replaces linear R, G, B of pixels by those that a display shows, from any thread; null: they
// stay.
using Grading = std::function<void(std::span<float> rgb)>;

// Returns the picture as it is shown. Its halves and their samples differ from it by noise, which
// is scaled by the derivative of the grading there, so that estimates without bias have none after
// it.
DenoisedPicture Graded(const DenoisedPicture&, const Grading&);

}  // namespace lull
