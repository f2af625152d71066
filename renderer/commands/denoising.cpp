#include "renderer/commands/denoising.h"

#include "renderer/base/say.h"
#include "renderer/base/seconds_since.h"
#include "renderer/render/progress.h"

namespace lull {

DenoisedImage DenoiseAndSay(NoisyPicture picture, const PixelRect& region,
                            const std::vector<Block>& blocks, bool quiet) {
    const auto start = std::chrono::steady_clock::now();
    DenoisedImage image = DenoiseImage(std::move(picture), region, blocks);
    if (!quiet)
        Say("denoised in {}; {}\n", FormatDuration(SecondsSince(start)), TextOf(image.blocks));
    return image;
}

}  // namespace lull
