// Reads images rendered before, to be compared.
#pragma once

#include "renderer/measure/comparison.h"

namespace lull {

struct ComparedFile {
    ComparedImage image;
    PixelRect region;        // of the whole image that it covers
    std::vector<float> spp;  // of each pixel; empty: not known
};

// Reads an EXR: R, G and B, and, if it is one of lull's, samples, rule and seconds. Throws Error.
ComparedFile ReadComparedFile(const std::string& path, const std::string& name);

// Sets what each block took where all of its pixels took the same.
void SetCosts(const std::vector<PixelRect>& blocks, ComparedFile* file);

}  // namespace lull
