// Checks an image taken from an observed render by rendering it by itself.
#pragma once

#include "renderer/lab/comparison/comparison.h"

namespace lull {

// One render of a rule's image by itself, to measure the cost and savings of the rule on a number
// of threads.
struct Verification {
    int threads = 0;
    double wallSeconds = 0;  // of the render
    double seconds = 0;      // of processors, spent on samples
    double ruleSeconds = 0;  // of processors, spent on the rule
    bool samePixels = false;
};

// Returns the cost of a render of a rule alone, whose result is `film`, and whether its image is
// the one that TakeImage() gave.
Verification VerificationOf(const RenderResult&, const Film& film, const ComparedImage& taken);

}  // namespace lull
