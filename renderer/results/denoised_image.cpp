#include "renderer/results/denoised_image.h"

#include <fmt/format.h>

#include "renderer/denoise/scales.h"
#include "renderer/denoise/visible_error.h"
#include "renderer/render/film_picture.h"

namespace lull {

namespace {

// Returns where blocks are in the region.
std::vector<PixelRect> PlacesOf(const std::vector<Block>& blocks, const PixelRect& region) {
    std::vector<PixelRect> places;
    for (const Block& block : blocks)
        places.push_back({block.pixels.min - region.min, block.pixels.max - region.min});
    return places;
}

DenoisedImage ImageOf(DenoiserResult result, const PixelRect& region) {
    return {{region.Width(), region.Height(), std::move(result.rgb)},
            std::move(result.deviation),
            std::move(result.blocks)};
}

}  // namespace

DenoisedImage DenoiseImage(NoisyPicture picture, const PixelRect& region,
                           const std::vector<Block>& blocks, const DenoiserOptions& options) {
    return ImageOf(RunDenoiser(std::move(picture), PlacesOf(blocks, region), options), region);
}

DenoisedImage DenoiseImage(GroupedPicture picture, const PixelRect& region,
                           const std::vector<Block>& blocks, const DenoiserOptions& options) {
    GroupedResult result = RunDenoiser(std::move(picture), PlacesOf(blocks, region), options);
    DenoisedImage image = ImageOf(std::move(result.sum), region);
    image.groups = std::move(result.groups);
    return image;
}

DenoisedImage DenoisePreview(const Film& film, int64_t mostPixels) {
    const PixelRect& region = film.Region();
    std::vector<Vec2i> sizes = {{region.Width(), region.Height()}};
    while (int64_t(sizes.back().x()) * sizes.back().y() > mostPixels)
        sizes.push_back((sizes.back() + Vec2i(1, 1)) / 2);
    if (sizes.size() == 1)
        return DenoiseImage(PictureOf(film, region), region, {}, {.effort = Effort::Quick});
    Planes picture = Denoise(ReducedPictureOf(film, int(sizes.size()) - 1), Effort::Quick).picture;
    for (size_t i = sizes.size() - 1; i-- > 0;)
        picture = Doubled(picture, sizes[i].x(), sizes[i].y());
    return {{picture.width, picture.height, Interleaved(picture)},
            std::vector<float>(picture.Area(), kUnknownError),
            {}};
}

std::string TextOf(const std::vector<std::optional<VisibleError>>& blocks) {
    std::vector<double> upper;
    int64_t worstPixels = 0;
    double worst = 0;
    for (const auto& error : blocks) {
        if (!error) continue;
        upper.push_back(error->upper);
        worstPixels += error->worstPixels;
        worst = std::max(worst, error->worst);
    }
    if (upper.empty())
        return fmt::format(
            "visible difference unknown: blocks have less than {} pixels a side, or few samples",
            kSmallestMeasuredSide);
    std::ranges::sort(upper);
    const bool isKnown = upper.size() == blocks.size();
    std::string text = fmt::format(
        "visible difference from the true image probably at most {:.2g} in half of the {}blocks{} "
        "and {:.2g} in all (accepted: {})",
        upper[upper.size() / 2], isKnown ? "" : fmt::format("{} ", upper.size()),
        isKnown ? "" : " of which it is known", upper.back(), kAcceptedBound);
    if (worstPixels == 1)
        text += fmt::format(", except for a pixel that may be wrong by {:.0f} in L*", worst);
    if (worstPixels > 1)
        text += fmt::format(", except for {} pixels that may be wrong by up to {:.0f} in L*",
                            worstPixels, worst);
    return text;
}

std::vector<ExrChannel> ColourChannels(const std::string& layer, std::span<const float> rgb) {
    std::vector<ExrChannel> channels;
    for (size_t c = 0; c < 3; ++c) {
        ExrChannel& channel = channels.emplace_back(ExrChannel{layer + "RGB" [c], {}});
        channel.values.reserve(rgb.size() / 3);
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
