// Finds and reads the pictures of another renderer: one viewpoint at increasing samples per pixel.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "renderer/image/image.h"
#include "renderer/lab/comparison/comparison.h"
#include "renderer/schedule/schedule.h"
#include "stopping/rules/rule.h"
#include "stopping/signals/attributes26.h"
#include "stopping/signals/svd_entropy.h"

namespace lull {

// The pictures of a folder, one at each spp, all of the same size.
struct PictureFolder {
    std::string name;                  // of the viewpoint
    std::map<int, std::string> files;  // by spp
    int width = 0, height = 0;

    std::vector<int> Spp() const;
    PixelRect Region() const { return {{0, 0}, {width, height}}; }
};

// Returns the spp in a picture's name (without folder): "room-40spp.png", "spp40.exr" or, where
// none says spp, the last number, as in "room_00040.png"; 0 if there is none.
int SppInName(const std::string& name);

// Finds all files of a folder but those whose names begin with a dot, and reads the size of the
// first. The viewpoint is called `name` or, if that is empty, as the folder. Throws Error for a
// folder that cannot be read or has no picture, a file without an spp, or two with the same.
PictureFolder FindPictures(const std::string& folder, const std::string& name = "");

// Does the same for a text FOLDER[:NAME].
PictureFolder FindNamedPictures(const std::string& text);

// Reads a picture that was found, as linear radiance: PNG, JPEG and 8-bit TIFF as sRGB, each 8-bit
// code as a value that a display shows as this code, and other formats as they are. Alpha is
// ignored. Throws Error, also if it has another size than the first.
RgbImage ReadPicture(const PictureFolder&, int spp);

// Returns whether a picture has display values rather than linear radiance.
bool IsDisplayPicture(const PictureFolder&, int spp);

// Returns the spp of a pass at whose ends the pictures are, if they are a recording's
// (IsRecorded(): each pass up to 400 spp, at least every second one after), or 0: at any spp.
int PassOfPictures(const std::vector<int>& spp);

// Measures the SVD-entropies of a picture, of its blocks and of their sub-blocks.

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

// Builds the images that stopping rules, or people, would have left of such pictures.

// A rule that stops blocks, and the name of its image.
struct PictureRule {
    std::string name;
    Rule rule;
};

struct PictureComparison {
    Comparison comparison;  // an image for each rule and, as the reference, the last picture
    // The rules that have checked no picture, as the pictures are too far apart for them.
    std::vector<std::string> blind = {};
};

// Shows the pictures, which come at the spp of the folder, to all rules; their context had the pass
// of PassOfPictures(). Each block is taken from the picture at which the rule stopped it, or the
// first that has as many spp as a rule that counts them says, or the last. Blocks too small for a
// rule follow their neighbour. Throws Error, also for a rule that compares halves of the samples.
PictureComparison ComparePictures(const PictureFolder&, const ScheduleOptions&,
                                  std::vector<PictureRule> rules);

}  // namespace lull
