// Filters images with small separable kernels.
#pragma once

#include <span>
#include <vector>

namespace lull {

// Returns the image, `width` x `height` values row by row, filtered by `alongX` in its rows and
// `alongY` in its columns; both have an odd length and are centred. Beyond the border the border
// pixels are repeated. As a correlation: alongX[0] weights the leftmost neighbour.
std::vector<float> Convolve(std::span<const float> image, int width, int height,
                            std::span<const double> alongX, std::span<const double> alongY);

// Returns exp(-x^2 / (2 sigma^2)) at x = -radius ... radius, divided by the sum.
std::vector<double> GaussianKernel(double sigma, int radius);

}  // namespace lull
