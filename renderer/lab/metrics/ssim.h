// Compares the structure of images: SSIM.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace lull {

// Half the side of the window, which is 11 x 11 pixels.
inline constexpr int kSsimRadius = 5;

// Returns the structural similarity around each pixel, in [-1, 1] and 1 where both images are the
// same, of two images in 8-bit sRGB (R, G, B of the first pixel, row by row): Wang, Bovik, Sheikh,
// Simoncelli: Image Quality Assessment: From Error Visibility to Structural Similarity, IEEE
// Transactions on Image Processing 13(4), 2004, with its Gaussian window (standard deviation 1.5),
// K1 = 0.01 and K2 = 0.03, on the luma 0.299 R + 0.587 G + 0.114 B. NaN where the window would
// extend beyond the image, where the paper defines no value.
std::vector<float> SsimMap(std::span<const uint8_t> image, std::span<const uint8_t> reference,
                           int width, int height);

}  // namespace lull
