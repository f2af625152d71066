// A rectangle of pixels.
#pragma once

#include "renderer/base/math.h"

namespace lull {

// The pixels [min, max).
struct PixelRect {
    Vec2i min = {0, 0}, max = {0, 0};

    int Width() const { return max.x() - min.x(); }
    int Height() const { return max.y() - min.y(); }
    int64_t Area() const { return int64_t(Width()) * Height(); }
    bool operator==(const PixelRect& r) const { return min == r.min && max == r.max; }
};

}  // namespace lull
