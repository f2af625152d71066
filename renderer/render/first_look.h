// Takes a first look at a picture, so that its first preview shows the whole of it.
#pragma once

#include "renderer/render/render.h"

namespace lull {

// Gives the film a first look: sample 0 of one pixel in each square of 4 x 4, which takes 1/16 of
// the time of one sample per pixel. The samples of the film stay as they are. Without effect where
// all pixels have samples, or if the render is cancelled.
void TakeFirstLook(const SampleSource& source, const RenderOptions& options, Film* film);

}  // namespace lull
