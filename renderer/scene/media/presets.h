// Lists measured media by name.
#pragma once

#include <string>

#include "renderer/base/math.h"

namespace lull {

// Finds absorption and reduced scattering, 1/mm, of a material of Jensen et al. 2001 or Narasimhan
// et al. 2006 by the name that pbrt-v3 has for it. Returns false, with both as they were, for
// others.
bool FindMediumPreset(const std::string& name, Rgb* sigmaA, Rgb* sigmaS);

}  // namespace lull
