#include "renderer/lab/viewpoints/picture_entropies.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "renderer/base/error.h"
#include "stopping/base/parallel.h"
#include "stopping/signals/lightness.h"

namespace lull {

namespace {

SvdEntropy MeanOf(std::span<const SvdEntropy> entropies) {
    SvdEntropy mean;
    for (const SvdEntropy& e : entropies) {
        mean.h += e.h / double(entropies.size());
        mean.h1 += e.h1 / double(entropies.size());
        mean.h2 += e.h2 / double(entropies.size());
    }
    return mean;
}

}  // namespace

EntropiesOfPicture MeasureEntropies(const RgbImage& picture, int blockSize, int subBlocks,
                                    bool withAttributes) {
    const PixelRect region{{0, 0}, {picture.width, picture.height}};
    const std::vector<Block> blocks = MakeBlocks(region, {.blockSize = blockSize});
    const int least = std::max(int(std::lround(std::sqrt(subBlocks))), 5);
    for (const Block& block : blocks)
        if (std::min(block.pixels.Width(), block.pixels.Height()) < least)
            throw Error(
                fmt::format("a block of {}x{} pixels is too small for {} sub-blocks; choose "
                            "another --block or fewer --sub-blocks",
                            block.pixels.Width(), block.pixels.Height(), subBlocks));
    EntropiesOfPicture result{
        .whole = {}, .mean = {}, .blocks = std::vector<BlockEntropies>(blocks.size())};
    const auto whole = [](const std::vector<double>& lightness, const PixelRect& rect) {
        return SubBlockEntropies(lightness, rect.Width(), rect.Height(), 1)[0];
    };
    result.whole = whole(LightnessOf(picture.values), region);
    ForEachIndex(int(blocks.size()), [&](int i) {
        const PixelRect& rect = blocks[size_t(i)].pixels;
        const std::vector<double> lightness =
            LightnessOf(CutPixels(picture.values, picture.width, rect));
        BlockEntropies& block = result.blocks[size_t(i)];
        block.pixels = rect;
        block.whole = whole(lightness, rect);
        block.subBlocks = SubBlockEntropies(lightness, rect.Width(), rect.Height(), subBlocks);
        block.mean = MeanOf(block.subBlocks);
        if (withAttributes)
            block.attributes = ComputeAttributes(lightness, rect.Width(), rect.Height());
    });
    std::vector<SvdEntropy> means;
    for (const BlockEntropies& block : result.blocks) means.push_back(block.mean);
    result.mean = MeanOf(means);
    return result;
}

}  // namespace lull
