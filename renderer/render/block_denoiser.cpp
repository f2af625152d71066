#include "renderer/render/block_denoiser.h"

#include "renderer/render/film_picture.h"

namespace lull {

DenoiserResult BlockDenoiser::Run(const PixelRect& pixels) const {
    const PixelRect whole{{0, 0}, {pixels.Width(), pixels.Height()}};
    // The picture in the end is a little better than that which is judged.
    const DenoiserOptions options{
        .effort = Effort::Quick, .withDeviation = false, .gradings = gradings};
    if (film->layers.Find<LightGroupLayer>())
        return RunDenoiser(GroupedPictureOf(*film, pixels), {&whole, 1}, options).sum;
    return RunDenoiser(PictureOf(*film, pixels), {&whole, 1}, options);
}

VisibleError BlockDenoiser::MeasureBlock(int block) const {
    const PixelRect& pixels = blocks.at(size_t(block)).pixels;
    const DenoiserResult result = Run(pixels);
    if (showPicture) showPicture(pixels, result.rgb);
    return result.blocks.front().value();
}

SignalMeasure MeasureOf(std::shared_ptr<const BlockDenoiser> denoiser) {
    return [denoiser](const BlockView&, const BlockInfo& block) -> Signals {
        return denoiser->MeasureBlock(block.index).estimate;
    };
}

}  // namespace lull
