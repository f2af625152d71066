// Removes noise from an image by wavelets.
#pragma once

#include <span>

namespace lull {

// Returns the median of the absolute values of the finest diagonal details of Daubechies 2, of
// those that are not 0, divided by the 3/4 quantile of the normal distribution; 0 if there are none
// (Donoho, Johnstone: Ideal spatial adaptation by wavelet shrinkage. Biometrika 81, 1994, 425).
// Beyond the border the image is reflected including its edge pixel. `image` holds width * height
// finite values, row-major, with at least 2 pixels a side.
double DiagonalNoise(std::span<const double> image, int width, int height);

// Sets those details of two levels of Daubechies 1 to 0 that are below `threshold` in absolute
// value, and reconstructs the rest in `shrunk`, which has the size of `image`. If a number of
// pixels is odd, the last is repeated.
void ShrinkDetails(std::span<const double> image, int width, int height, double threshold,
                   std::span<double> shrunk);

}  // namespace lull
