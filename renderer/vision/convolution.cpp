#include "renderer/vision/convolution.h"

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

}  // namespace lull
