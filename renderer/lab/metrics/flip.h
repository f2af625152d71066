// Compares images as people do who flip between them: FLIP.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace lull {

// Returns the pixels per degree of vision at the viewing conditions that the paper's program takes
// by default: 0.7 m before a display 0.7 m and 3840 pixels wide.
double DefaultPixelsPerDegree();

// Returns the difference that an observer sees at each pixel, in [0, 1] and 0 where both images are
// the same, of two images in 8-bit sRGB (R, G, B of the first pixel, row by row): Andersson,
// Nilsson, Akenine-Moller, Oskarsson, Astrom, Fairchild: FLIP: A Difference Evaluator for
// Alternating Images, Proceedings of the ACM on Computer Graphics and Interactive Techniques 3(2),
// 2020. The mean over the map is the figure for an image.
std::vector<float> FlipMap(std::span<const uint8_t> image, std::span<const uint8_t> reference,
                           int width, int height, double pixelsPerDegree);

}  // namespace lull
