// Writes the pictures of a render: EXR, with a header that says how it was made, and PNG.
#pragma once

#include <string>
#include <vector>

#include "renderer/base/math.h"
#include "renderer/files/outputs.h"
#include "renderer/image/image_io.h"
#include "renderer/render/provenance.h"
#include "renderer/render/render.h"
#include "renderer/results/layer_channels.h"

namespace lull {

struct PictureFormat {
    Grade grade = {};  // of the PNG
    int pngBits = 8;
    // Colours and normals of the EXR take 16 bits; depths, positions, numbers and counts 32.
    bool exrHalf = false;
    // Both lack the background that the camera sees past everything, and the PNG has alpha.
    bool isTransparent = false;
};

struct PictureFiles {
    std::string exr, png;
};

struct PictureOrigin {
    const Scene& scene;
    const Provenance& provenance;
};

// The image of a render: the means of the film or, where there is one, the denoised image, with the
// means beside it in the EXR. The film has mattes where the format is transparent.
struct Picture {
    const Film& film;
    const DenoisedImage* denoised = nullptr;  // null: there is none
    const RenderResult& result;
    LayerChannels layers = {};  // of the EXR
    const PictureFormat& format;
};

// Writes it, each file whole or not at all. Returns how many values were clamped to 16 bits.
int64_t WriteImage(const PictureFiles&, const PictureOrigin&, Picture, ResultFiles*);

// Returns the rows of an image, which must outlive that.
RowSource MeansOf(const RgbImage&);

// Writes an image as of a render whose block i, of those in `blocks`, took spp[i].
struct ImageOfBlocks {
    const RgbImage& image;
    const std::vector<Block>& blocks;
    const std::vector<int>& spp;
    double seconds;  // of processors
};
void WriteImage(const PictureFiles&, const PictureOrigin&, const ImageOfBlocks&, ResultFiles*);

// The windows of an EXR: its data can be a part of the picture, and reach beyond.

PixelRect DataWindow(const ExrImage&);

// Returns the window of the picture that a file shows: of our own renders the part that was
// rendered (--crop), of other programs' the display window. Throws Error with `file` where that
// needs more memory than there is.
PixelRect ShownWindow(const ExrImage&, const std::string& file);

// Returns interleaved channels of the data window, moved to another window; 0 where data lack.
std::vector<float> MovedTo(const PixelRect& window, const PixelRect& data, int channels,
                           const std::vector<float>& values);

// Moves all channels so; the display window stays.
void MoveTo(const PixelRect& window, ExrImage*);

}  // namespace lull
