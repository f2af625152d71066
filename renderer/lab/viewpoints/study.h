// What people are shown when they say where they still see noise.
#pragma once

#include <map>
#include <string>

#include "renderer/lab/viewpoints/picture_ladder.h"
#include "renderer/render/schedule.h"

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
    std::map<std::string, std::string> provenance = {};  // what the pictures were made from
};

// Returns 16 hexadecimal digits that tell studies apart: a hash of names, levels, positions and all
// pictures. Answers to one study say nothing about another.
std::string StudyId(const Study&);

// Returns the root of the mean squared difference in lightness (0 to 100) between a block at a
// level and the reference.
double NoiseOf(const StudyBlock&, size_t level);

// Makes a study from the pictures of another renderer: all files of a folder whose names contain
// their spp ("room-40spp.png", "spp40.exr" or, where no name says spp, the last number, as in
// "room_00040.png"), 8-bit ones as they are, others as linear radiance. Takes those nearest to the
// levels of a ladder of `count` levels or, where count is 0, of steps of `ratio`. Throws Error.
Study ReadStudy(const std::string& folder, const std::string& viewpoint, int blockSize, int count,
                double ratio);

// Returns the spp that the name of a picture (without folder) says; 0 if it says none.
int SppInName(const std::string& name);

}  // namespace lull
