// Measures the SVD-entropies of a picture, of its blocks and of their sub-blocks.
#pragma once

#include "renderer/lab/viewpoints/picture_folder.h"
#include "stopping/signals/attributes26.h"
#include "stopping/signals/svd_entropy.h"

namespace lull {

struct BlockEntropies {
    PixelRect pixels;
    SvdEntropy whole;                                 // of the block as one matrix
    SvdEntropy mean;                                  // over the sub-blocks, as are
    std::vector<SvdEntropy> subBlocks;                // row by row
    std::array<double, kAttributes> attributes = {};  // the 26 of the block, if asked for
};

struct EntropiesOfPicture {
    SvdEntropy whole;  // of the picture as one matrix
    SvdEntropy mean;   // over the blocks, of their means
    std::vector<BlockEntropies> blocks;
};

// Measures the lightness of a picture as an 8-bit display shows it, in blocks of so many pixels a
// side, each in `subBlocks` parts, a square number. Throws Error for a block with fewer pixels a
// side than sub-blocks, or than the 5 that the attributes need. Shares the blocks between threads.
EntropiesOfPicture MeasureEntropies(const RgbImage& picture, int blockSize, int subBlocks,
                                    bool withAttributes);

}  // namespace lull
