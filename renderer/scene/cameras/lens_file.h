// Reads descriptions of lenses.
#pragma once

#include <vector>

#include "renderer/base/error.h"
#include "renderer/scene/cameras/lens_system.h"

namespace lull {

// Reads the lens file of pbrt-v3: for each interface, from the scene to the film, radius of
// curvature (0: the stop), thickness, index of refraction and diameter, lengths in millimetres.
// Throws Error, beginning with the file, if a row is cut short, there are none or too many, or a
// number is out of range. `loc` is the place that names the file.
std::vector<LensInterface> LoadLens(const std::string& path, const FileLoc& loc);

}  // namespace lull
