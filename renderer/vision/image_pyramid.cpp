#include "renderer/vision/visible_difference.h"

#include <algorithm>
#include <cmath>

namespace lull {

namespace {

// Adds `weight` times row `from` to row `to`.
void AddRow(const float* from, double weight, int width, double* to) {
    for (int x = 0; x < width; ++x) to[x] += weight * double(from[x]);
}

}  // namespace

std::vector<float> Convolve(std::span<const float> image, int width, int height,
                            std::span<const double> alongX, std::span<const double> alongY) {
    const int radiusX = int(alongX.size()) / 2, radiusY = int(alongY.size()) / 2;
    std::vector<float> rows(image.size()), result(image.size());
    std::vector<float> padded(size_t(width + 2 * radiusX));
    std::vector<double> sums(size_t(width), 0);
    const auto store = [&](std::vector<float>& to, int y) {
        for (int x = 0; x < width; ++x) to[size_t(y) * width + x] = float(sums[x]);
    };

    for (int y = 0; y < height; ++y) {
        const float* row = &image[size_t(y) * width];
        for (int x = 0; x < int(padded.size()); ++x)
            padded[x] = row[std::clamp(x - radiusX, 0, width - 1)];
        std::ranges::fill(sums, 0);
        for (size_t i = 0; i < alongX.size(); ++i) AddRow(&padded[i], alongX[i], width, &sums[0]);
        store(rows, y);
    }
    for (int y = 0; y < height; ++y) {
        std::ranges::fill(sums, 0);
        for (int i = 0; i < int(alongY.size()); ++i) {
            const int from = std::clamp(y + i - radiusY, 0, height - 1);
            AddRow(&rows[size_t(from) * width], alongY[i], width, &sums[0]);
        }
        store(result, y);
    }
    return result;
}

std::vector<double> GaussianKernel(double sigma, int radius) {
    std::vector<double> kernel;
    double sum = 0;
    for (int x = -radius; x <= radius; ++x) {
        kernel.push_back(std::exp(-0.5 * x * x / (sigma * sigma)));
        sum += kernel.back();
    }
    for (double& k : kernel) k /= sum;
    return kernel;
}

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
