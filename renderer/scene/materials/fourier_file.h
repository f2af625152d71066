// Reads the .bsdf files of layered materials.
#pragma once

#include <string>

#include "renderer/bsdf/fourier_lobe.h"

namespace lull {

// Reads version 1 of the format, as layerlab writes it and pbrt-v3 reads it: one basis, without
// textures and extrapolation, one channel or three. Throws Error with the path if it is anything
// else, cut short, or holds impossible numbers.
FourierTable LoadFourierTable(const std::string& path);

}  // namespace lull
