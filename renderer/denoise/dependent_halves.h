// Finds halves of the samples whose noise is not independent, which therefore cannot judge each
// other.
#pragma once

#include <string>

#include "renderer/denoise/planes.h"

namespace lull {

// Returns why two halves, R, G, B, of one size, are not independent, or "". Found are
//   - the same values, unless all pixels are alike, which have no noise;
//   - noise that both have: nowhere smooth, with the spectrum of noise, and more than three times
//     as strong as their difference, for which a picture of white noise is mistaken too;
//   - samples of one that the other has too, or six times as many samples.
// The second and third need some 12 tiles of 16 x 16 pixels in which there is anything to see.
std::string DependenceOf(const Halves&);

}  // namespace lull
