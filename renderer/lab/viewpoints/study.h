// Builds the images of a study in which observers mark visible noise.
#pragma once

#include <map>
#include <string>

#include "renderer/lab/viewpoints/picture_folder.h"
#include "renderer/lab/viewpoints/picture_ladder.h"
#include "renderer/schedule/schedule.h"

namespace lull {

struct StudyBlock {
    PixelRect pixels;                     // of the image
    std::vector<DisplayPixels> pictures;  // one for each level
};

// One viewpoint: its blocks, row by row, at every level of a ladder, the last of which is the
// reference.
struct Study {
    std::string viewpoint;  // its name in thresholds files
    int width = 0, height = 0;
    std::vector<int> levels = {};  // spp, increasing, at least two
    std::vector<StudyBlock> blocks = {};
    std::map<std::string, std::string> provenance = {};  // of the pictures
};

// Returns 16 hexadecimal digits that tell studies apart: a hash of names, levels, positions and all
// pictures. Answers to one study say nothing about another.
std::string StudyId(const Study&);

// Returns the root of the mean squared difference in lightness (0 to 100) between a block at a
// level and the reference.
double NoiseOf(const StudyBlock&, size_t level);

// Makes a study of the pictures of another renderer: of those nearest to the levels of a ladder of
// `count` levels or, where count is 0, of steps of `ratio`. Throws Error.
Study MakeStudy(const PictureFolder&, int blockSize, int count, double ratio);

}  // namespace lull
