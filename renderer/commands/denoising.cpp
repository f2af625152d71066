#include "renderer/commands/denoising.h"

#include <fmt/format.h>

#include "renderer/base/say.h"
#include "renderer/base/seconds_since.h"
#include "renderer/render/progress.h"

namespace lull {

DenoisedImage DenoiseAndSay(NoisyPicture picture, const PixelRect& region,
                            const std::vector<Block>& blocks, bool quiet, const Talk& talk,
                            const std::function<void(DenoisedImage*)>& check) {
    const auto start = std::chrono::steady_clock::now();
    DenoisedImage image = DenoiseImage(std::move(picture), region, blocks);
    if (check) check(&image);
    const std::string text = fmt::format("denoised in {}; {}", FormatDuration(SecondsSince(start)),
                                         TextOf(image.blocks));
    if (!quiet && talk.isJson)
        talk.Note(text);
    else if (!quiet)
        Say("{}\n", text);
    return image;
}

}  // namespace lull
