// Measures how much noise filters remove from an image: the 26 attributes that SVD-entropy is
// compared with.
//
// After Constantin, Bigand, Constantin, Hamad: Image noise detection in global illumination methods
// based on FRVM. Neurocomputing 2015, 164, 82; with which the paper (svd_entropy.h) trained its
// competing network.
#pragma once

#include <array>
#include <span>

namespace lull {

// Returns the means of |L - filtered L| for 13 filters, then the standard deviations (of the
// population), in the unit of L. The filters are: mean 3x3 and 5x5; Gaussian 3x3 with a standard
// deviation of 0.5, 1 and 1.5 pixels, then 5x5 with the same; median 3x3 and 5x5; Wiener 3x3 and
// 5x5; hard shrinkage of two levels of wavelets by the universal threshold, sigma sqrt(2
// log(pixels)) with sigma = DiagonalNoise() (attributes26.h).
//
// Beyond the border, mean and Gaussian see the image reflected without its edge pixel, median and
// Wiener (Lim 1990, Eqs. 9.44 to 9.46, with the mean of the local variances as that of the noise)
// see zeros. This causes errors in the outermost pixels, the same for all blocks.
//
// `lightness` holds width * height values, row-major. Throws std::invalid_argument if it does not,
// if there are fewer than 5 pixels a side, or if a value is not finite; finite values beyond 1e100
// may overflow, and then count as 0.
inline constexpr int kAttributes = 26;
std::array<double, kAttributes> ComputeAttributes(std::span<const double> lightness, int width,
                                                  int height);

// Removes noise from an image by wavelets.

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
