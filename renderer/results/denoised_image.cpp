#include "renderer/results/denoised_image.h"

#include <fmt/format.h>

namespace lull {

namespace {

constexpr int kSmallest = 10;  // pixels a side of a block whose visible error can be measured

}  // namespace

DenoisedImage DenoiseImage(NoisyPicture picture, const PixelRect& region,
                           const std::vector<Block>& blocks) {
    DenoisedPicture denoised = Denoise(std::move(picture));
    std::vector<float> standardError = StandardError(denoised).values;
    const EstimatedError error = MeasureError(denoised);
    denoised.halves = denoised.noisy = {};  // a large picture needs the memory
    DenoisedImage result{{region.Width(), region.Height(), Interleaved(denoised.picture)},
                         std::move(standardError),
                         {}};
    denoised = {};
    for (const Block& block : blocks) {
        const Vec2i min = block.pixels.min - region.min, max = block.pixels.max - region.min;
        const bool isSmall = std::min(max.x() - min.x(), max.y() - min.y()) < kSmallest;
        result.blocks.emplace_back();
        if (!isSmall)
            result.blocks.back() = MeasureVisibleError(error, min.x(), min.y(), max.x(), max.y());
    }
    return result;
}

std::string TextOf(const std::vector<std::optional<VisibleError>>& blocks) {
    std::vector<double> upper;
    for (const auto& error : blocks)
        if (error) upper.push_back(error->upper);
    if (upper.empty())
        return fmt::format("visible error not known of blocks below {} pixels a side", kSmallest);
    std::ranges::sort(upper);
    return fmt::format(
        "visible error in lightness, of 0 to 100, probably at most {:.2f} in half of "
        "the blocks and {:.2f} in all",
        upper[upper.size() / 2], upper.back());
}

std::vector<ExrChannel> ColourChannels(const std::string& layer, std::span<const float> rgb) {
    std::vector<ExrChannel> channels;
    for (size_t c = 0; c < 3; ++c) {
        ExrChannel& channel = channels.emplace_back(ExrChannel{layer + "RGB" [c], {}});
        for (size_t i = c; i < rgb.size(); i += 3) channel.values.push_back(rgb[i]);
    }
    return channels;
}

std::vector<ExrChannel> MakeDenoisedChannels(const DenoisedImage& image,
                                             std::span<const float> noisy) {
    std::vector<ExrChannel> channels = ColourChannels("noisy.", noisy);
    channels.push_back({"error", image.error});
    return channels;
}

}  // namespace lull
