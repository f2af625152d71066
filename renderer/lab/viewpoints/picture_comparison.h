// Builds the images that stopping rules, or people, would have left of another renderer's pictures.
#pragma once

#include "renderer/lab/comparison/comparison.h"
#include "renderer/lab/viewpoints/picture_folder.h"
#include "stopping/rules/rule.h"

namespace lull {

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
// of PassOfPictures(). Each block is taken from the picture at which the rule stopped it, or
// the first that has as many spp as a rule that counts them says, or the last. Blocks too small for
// a rule follow their neighbour. Reads a picture only where it is needed. Throws Error, also for a
// rule that compares halves of the samples, which pictures do not have. Call Measure() for figures.
PictureComparison ComparePictures(const PictureFolder&, const ScheduleOptions&,
                                  std::vector<PictureRule> rules);

}  // namespace lull
