// Lists measured media by name.
#pragma once

#include <string>

#include "renderer/base/math.h"

namespace lull {

// Finds absorption and reduced scattering, 1/mm, of a material of Jensen et al. 2001 or Narasimhan
// et al. 2006 by its name in pbrt-v3. Returns false, and leaves both unchanged, for other names.
bool FindMediumPreset(const std::string& name, Rgb* sigmaA, Rgb* sigmaS);

}  // namespace lull
