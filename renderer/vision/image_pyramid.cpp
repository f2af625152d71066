#include "renderer/vision/image_pyramid.h"

#include <algorithm>

namespace lull {

namespace {

constexpr float kKernel[3] = {0.4f, 0.25f, 0.05f};  // from the centre on

int Mirrored(int i, int size) {
    return std::clamp(i < 0 ? -1 - i : i >= size ? 2 * size - 1 - i : i, 0, size - 1);
}

// A line of an image: `size` values, `stride` apart.
template <typename Value>
struct Line {
    Value* values;
    int size;
    size_t stride;
    Value& operator[](int i) const { return values[size_t(i) * stride]; }
};

void ReduceLine(const Line<const float>& from, const Line<float>& to) {
    for (int i = 0; i < to.size; ++i) {
        const auto at = [&](int offset) { return from[Mirrored(2 * i + offset, from.size)]; };
        to[i] = kKernel[0] * at(0) + kKernel[1] * (at(-1) + at(1)) + kKernel[2] * (at(-2) + at(2));
    }
}

void ExpandLine(const Line<const float>& from, const Line<float>& to) {
    for (int i = 0; i < to.size; ++i) {
        const int j = i / 2, next = std::min(j + 1, from.size - 1);
        to[i] =
            i % 2
                ? 2 * kKernel[1] * (from[j] + from[next])
                : 2 * (kKernel[0] * from[j] + kKernel[2] * (from[std::max(j - 1, 0)] + from[next]));
    }
}

// Applies `filter` to all rows and then to all columns.
template <typename Filter>
Plane Separably(const Plane& from, int width, int height, const Filter& filter) {
    Plane rows{width, from.height, std::vector<float>(size_t(width) * size_t(from.height))};
    for (int y = 0; y < from.height; ++y)
        filter(Line<const float>{&from.values[size_t(y) * size_t(from.width)], from.width, 1},
               Line<float>{&rows.values[size_t(y) * size_t(width)], width, 1});
    Plane to{width, height, std::vector<float>(size_t(width) * size_t(height))};
    for (int x = 0; x < width; ++x)
        filter(Line<const float>{&rows.values[size_t(x)], rows.height, size_t(width)},
               Line<float>{&to.values[size_t(x)], height, size_t(width)});
    return to;
}

}  // namespace

Plane Reduce(const Plane& plane) {
    return Separably(plane, (plane.width + 1) / 2, (plane.height + 1) / 2,
                     [](const auto& from, const auto& to) { ReduceLine(from, to); });
}

Plane Expand(const Plane& plane, int width, int height) {
    return Separably(plane, width, height,
                     [](const auto& from, const auto& to) { ExpandLine(from, to); });
}

}  // namespace lull
