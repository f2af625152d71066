#include "renderer/commands/denoising.h"

#include <fmt/format.h>

#include "renderer/base/say.h"
#include "renderer/render/progress.h"

namespace lull {

void PrintDenoised(const DenoisedImage& image, double seconds, bool quiet, const Talk& talk) {
    if (quiet) return;
    const std::string text =
        fmt::format("denoised in {}; {}", FormatDuration(seconds), TextOf(image.blocks));
    if (talk.isJson)
        talk.Note(text);
    else
        Say("{}\n", text);
}

}  // namespace lull
