#include "renderer/render/block_denoiser.h"

#include "renderer/render/film_picture.h"

namespace lull {

VisibleError BlockDenoiser::MeasureBlock(int block) const {
    constexpr int rowsPerFit = 2;  // the picture in the end is a little better than that judged
    const PixelRect& pixels = blocks.at(size_t(block)).pixels;
    const DenoisedPicture denoised = Denoise(PictureOf(*film, *featureFilm, pixels), rowsPerFit);
    if (showPicture) showPicture(pixels, Interleaved(denoised.picture));
    return MeasureVisibleError(MeasureError(denoised), 0, 0, pixels.Width(), pixels.Height());
}

SignalMeasure MeasureOf(std::shared_ptr<const BlockDenoiser> denoiser) {
    return [denoiser](const BlockView&, const BlockInfo& block) -> Signals {
        return denoiser->MeasureBlock(block.index).upper;
    };
}

}  // namespace lull
