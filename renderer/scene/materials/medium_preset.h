// Reads measured coefficients of media by name.
#pragma once

#include <string>

#include "renderer/base/error.h"
#include "renderer/base/math.h"

namespace lull {

// Absorption and scattering. Those that were measured are reduced: the mean cosine is 0.
struct MediumPreset {
    Rgb sigmaA, sigmaS;
    bool isMeasured = false;
};

// Returns the coefficients of that name; pbrt-v3's default for "" and, with a warning, for names
// that no table has.
MediumPreset ReadMediumPreset(const std::string& name, const FileLoc& loc, Warnings& warnings);

}  // namespace lull
