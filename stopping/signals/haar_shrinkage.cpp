#include "stopping/signals/haar_shrinkage.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace lull {

namespace {

// Takes, from each 2x2 pixels of `image`, the details below the threshold out of `rest` (of the
// same size, each value of which covers scale x scale of its pixels), and returns the averages,
// which are half as many a side.
std::vector<double> TakeDetails(std::span<const double> image, int width, int height,
                                double threshold, int scale, int restWidth, int restHeight,
                                std::span<double> rest) {
    const int halfWidth = (width + 1) / 2, halfHeight = (height + 1) / 2;
    std::vector<double> averages(size_t(halfWidth) * size_t(halfHeight));
    const auto small = [&](double v) { return std::abs(v) < threshold ? v / (2 * scale) : 0; };
    for (int y = 0; y < halfHeight; ++y)
        for (int x = 0; x < halfWidth; ++x) {
            const int x1 = std::min(2 * x + 1, width - 1), y1 = std::min(2 * y + 1, height - 1);
            const double a = image[size_t(2 * y * width + 2 * x)];
            const double b = image[size_t(2 * y * width + x1)];
            const double c = image[size_t(y1 * width + 2 * x)];
            const double d = image[size_t(y1 * width + x1)];
            averages[size_t(y * halfWidth + x)] = (a + b + c + d) / 2;
            const double along = small((a - b + c - d) / 2), across = small((a + b - c - d) / 2);
            const double diagonal = small((a - b - c + d) / 2);
            const int right = std::min((2 * x + 2) * scale, restWidth);
            const int bottom = std::min((2 * y + 2) * scale, restHeight);
            for (int v = 2 * y * scale; v < bottom; ++v)
                for (int u = 2 * x * scale; u < right; ++u) {
                    const double s = u < (2 * x + 1) * scale ? 1 : -1;
                    const double t = v < (2 * y + 1) * scale ? 1 : -1;
                    rest[size_t(v * restWidth + u)] -= s * along + t * across + s * t * diagonal;
                }
        }
    return averages;
}

}  // namespace

double DiagonalNoise(std::span<const double> image, int width, int height) {
    // The high-pass of Daubechies 2, to be folded with the image.
    const double root3 = std::sqrt(3.0), scale = 1 / (4 * std::sqrt(2.0));
    const double high[4] = {-(1 + root3) * scale, (3 + root3) * scale, -(3 - root3) * scale,
                            (1 - root3) * scale};
    const auto reflect = [](int i, int n) { return i < 0 ? -1 - i : i >= n ? 2 * n - 1 - i : i; };
    const int columns = (width + 3) / 2, lines = (height + 3) / 2;
    std::vector<double> filtered(size_t(columns) * size_t(height));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < columns; ++x)
            for (int j = 0; j < 4; ++j)
                filtered[size_t(y * columns + x)] +=
                    high[j] * image[size_t(y * width + reflect(2 * x + 1 - j, width))];
    std::vector<double> details;
    details.reserve(size_t(columns) * size_t(lines));
    for (int y = 0; y < lines; ++y)
        for (int x = 0; x < columns; ++x) {
            double sum = 0;
            for (int j = 0; j < 4; ++j)
                sum += high[j] * filtered[size_t(reflect(2 * y + 1 - j, height) * columns + x)];
            if (sum != 0) details.push_back(std::abs(sum));
        }
    if (details.empty()) return 0;
    const auto middle = details.begin() + ptrdiff_t(details.size() / 2);
    std::nth_element(details.begin(), middle, details.end());
    const double above = *middle;
    const double below =
        details.size() % 2 == 1 ? above : *std::max_element(details.begin(), middle);
    return (below + above) / 2 / 0.674489750196081743;
}

void ShrinkDetails(std::span<const double> image, int width, int height, double threshold,
                   std::span<double> shrunk) {
    std::ranges::copy(image, shrunk.begin());
    const std::vector<double> averages =
        TakeDetails(image, width, height, threshold, 1, width, height, shrunk);
    TakeDetails(averages, (width + 1) / 2, (height + 1) / 2, threshold, 2, width, height, shrunk);
}

}  // namespace lull
