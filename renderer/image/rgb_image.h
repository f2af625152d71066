// A rendered image in memory.
#pragma once

#include <vector>

namespace lull {

// Linear RGB, row-major triples.
struct RgbImage {
    int width = 0, height = 0;
    std::vector<float> values;
};

}  // namespace lull
