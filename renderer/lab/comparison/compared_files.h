// Reads images rendered before, to be compared.
#pragma once

#include "renderer/lab/comparison/comparison.h"

namespace lull {

struct ComparedFile {
    ComparedImage image;
    PixelRect region;        // of the whole image that it covers
    PixelRect shown;         // the window of the picture (ShownWindow()), black outside of `region`
    std::vector<float> spp;  // of each pixel; empty: not known
    bool isPair = false;     // of two eyes, the right one's beside the left one's
};

// Returns whether a file has an image's extension: .exr, or that of a display image, in any case.
bool IsImageFile(const std::string& path);

// Returns whether a file has the extension of a display image: .png, .jpg, .jpeg, .tif or .tiff.
bool IsDisplayFile(const std::string& path);

// Reads an EXR: R, G and B, or Y for all three, and, if it is one of lull's, samples, rule and
// seconds, also of the views "left" and "right" of a pair; or a picture for displays, taken as sRGB
// whatever profile it has, without its alpha, whose region begins at (0, 0). Throws Error, also for
// a TIFF of more than 8 bits, which may be linear or not.
ComparedFile ReadComparedFile(const std::string& path, const std::string& name);

// Reads such a file as the picture that it shows (ShownWindow()). Throws Error, also for a pair.
RgbImage ReadShownPicture(const std::string& path);

// Reads an image to be compared with others of a region and blocks that are known; a picture for
// displays of the same size can be of any part. Its wall seconds are 0 if the file has none. Throws
// Error if it shows another part of the image.
ComparedImage ReadImageBeside(const std::string& path, const std::string& name, const Comparison&);

// Returns a comparison of files, the last of which is the reference, read from the file of that
// name: of their data, or, if these are of different regions, of the pictures that they show. The
// cap is the most samples that it has. Throws Error if they do not fit together.
Comparison ComparisonOf(std::vector<ComparedFile> files, const std::string& reference,
                        ScheduleOptions);

// Returns the region of the EXRs among the files; a picture for displays of the same
// size can be of any part. The last of `files` is the reference, from the file of that name. Throws
// Error if they do not fit together.
PixelRect CommonRegion(const std::vector<ComparedFile>& files, const std::string& reference);

// Returns the metrics that display images lack; empty if there are none of these among the images.
std::string DisplayNote(const Comparison&);

// Sets the cost of each block whose pixels all took the same number of samples.
void SetCosts(const std::vector<PixelRect>& blocks, ComparedFile* file);

}  // namespace lull
