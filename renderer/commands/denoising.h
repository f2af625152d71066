// Messages of the commands that denoise.
#pragma once

#include "renderer/commands/talk.h"
#include "renderer/results/denoised_image.h"

namespace lull {

// Prints how long denoising took and how clean the picture is, unless `quiet`.
void PrintDenoised(const DenoisedImage&, double seconds, bool quiet, const Talk& = {});

}  // namespace lull
