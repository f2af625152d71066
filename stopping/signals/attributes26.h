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
// log(pixels)) with sigma = DiagonalNoise() (haar_shrinkage.h).
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

}  // namespace lull
