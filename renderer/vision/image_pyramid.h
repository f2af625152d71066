// Halves and doubles images, as a Laplacian pyramid needs it.
#pragma once

#include <span>
#include <vector>

namespace lull {

// Filters images with small separable kernels.

// Returns the image, `width` x `height` values row by row, filtered by `alongX` in its rows and
// `alongY` in its columns; both have an odd length and are centred. Beyond the border the border
// pixels are repeated. As a correlation: alongX[0] weights the leftmost neighbour.
std::vector<float> Convolve(std::span<const float> image, int width, int height,
                            std::span<const double> alongX, std::span<const double> alongY);

// Returns exp(-x^2 / (2 sigma^2)) at x = -radius ... radius, divided by the sum.
std::vector<double> GaussianKernel(double sigma, int radius);

// A value at each pixel, row by row.
struct Plane {
    int width = 0, height = 0;
    std::vector<float> values;
};

// Returns the image at half the resolution, rounded up, with the kernel (1, 5, 8, 5, 1) / 20 and
// its border mirrored: Burt, Adelson: The Laplacian Pyramid as a Compact Image Code, IEEE
// Transactions on Communications 31(4), 1983, with a = 0.4. Pixel (x, y) is centred where pixel
// (2 x, 2 y) was.
Plane Reduce(const Plane&);

// Interpolates to `width` x `height`, where the image has the size of Reduce() of such a one.
Plane Expand(const Plane&, int width, int height);

}  // namespace lull
