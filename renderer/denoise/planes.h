// Images as planes, one per channel, for vector instructions.
#pragma once

#include <algorithm>
#include <cstddef>
#include <limits>
#include <span>
#include <vector>

#include "renderer/base/color.h"
#include "renderer/base/memory.h"

namespace lull {

// `count` channels of width x height values, channel by channel, row by row from the top. They are
// 0 at first; those of large images take memory only where they are written.
struct Planes {
    int width = 0, height = 0, count = 0;
    std::vector<float, ZeroAllocator<float>> values;

    Planes() = default;
    Planes(int width, int height, int count)
        : width(width), height(height), count(count), values(Area() * size_t(count)) {}
    Planes(int width, int height, int count, float value)
        : width(width), height(height), count(count), values(Area() * size_t(count), value) {}

    size_t Area() const { return size_t(width) * size_t(height); }
    float* Plane(int c) { return values.data() + size_t(c) * Area(); }
    const float* Plane(int c) const { return values.data() + size_t(c) * Area(); }
    float* Row(int c, int y) { return Plane(c) + size_t(y) * size_t(width); }
    const float* Row(int c, int y) const { return Plane(c) + size_t(y) * size_t(width); }

    // Frees the rows [y0, y1), whose values become unknown.
    void ForgetRows(int y0, int y1) {
        for (int c = 0; c < count && y0 < y1; ++c)
            ForgetValues(std::as_bytes(std::span(Row(c, y0), Row(c, y1))));
    }
};

inline constexpr int kColours = 3;  // R, G, B

// Two half buffers.
struct Halves {
    Planes a, b;
};
inline Halves MakeHalves(int width, int height, int count) {
    return {Planes(width, height, count), Planes(width, height, count)};
}

// Returns the luminance of pixel i of an image with channels R, G, B.
inline float LuminanceOf(const Planes& image, size_t i) {
    return Luminance(Rgb(image.Plane(0)[i], image.Plane(1)[i], image.Plane(2)[i]));
}

inline constexpr float kLargest = 1e18f;  // its square is finite

// Returns 0 for values that are negative or not finite, and at most kLargest.
inline float Sane(float x) {
    return x > 0 && x <= std::numeric_limits<float>::max() ? std::min(x, kLargest) : 0;
}

// Returns the values pixel by pixel, with adjacent channels.
std::vector<float> Interleaved(const Planes&);

// Returns half the squared difference of two images: of a value of either, where they differ by
// noise alone, the variance, with one degree of freedom.
Planes VarianceOf(const Planes& a, const Planes& b);

// Return the mean or the sum of each channel over the (2 radius + 1)^2 pixels around, those within
// the image. Each sum is computed afresh, so that a part of an image has the same bits as the
// whole, and bright pixels leave no rounding errors farther away.
Planes BoxMean(Planes, int radius);
Planes BoxSum(Planes, int radius);

}  // namespace lull
