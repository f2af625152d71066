// Denoises finished pictures, for commands that do.
#pragma once

#include <functional>

#include "renderer/commands/talk.h"
#include "renderer/results/denoised_image.h"

namespace lull {

// Is DenoiseImage(), which says how long it took and how clean the picture is, unless `quiet`;
// before, `check` can take back errors of blocks that are not known.
DenoisedImage DenoiseAndSay(NoisyPicture, const PixelRect& region, const std::vector<Block>& blocks,
                            bool quiet, const Talk& = {},
                            const std::function<void(DenoisedImage*)>& check = {});

}  // namespace lull
