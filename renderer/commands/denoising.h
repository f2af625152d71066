// Denoises finished pictures, for commands that do.
#pragma once

#include "renderer/commands/talk.h"
#include "renderer/results/denoised_image.h"

namespace lull {

// Is DenoiseImage(), which says how long it took and how clean the picture is, unless `quiet`.
DenoisedImage DenoiseAndSay(NoisyPicture, const PixelRect& region, const std::vector<Block>& blocks,
                            bool quiet, const Talk& = {});

}  // namespace lull
