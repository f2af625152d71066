// Tells scenes apart.
#pragma once

#include <string>

#include "renderer/input/description.h"

namespace lull {

// Returns "crc32:" and eight hexadecimal digits, made of everything in a description and of the
// contents of all files that its parameters name (meshes, images, spectra). Names of folders do not
// count, so a scene that has been moved is the same one. Files that are missing count as empty:
// to report them is left to who needs them.
std::string SceneHash(const Description&);

}  // namespace lull
