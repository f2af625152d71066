// Identifies scenes.
#pragma once

#include <string>

#include "renderer/input/description.h"

namespace lull {

// Returns "crc32:" and eight hexadecimal digits, computed from everything in a description and from
// the contents of all files that its parameters name (meshes, images, spectra). Names of folders do
// not count, so a scene that has been moved stays the same. Missing files count as empty: whoever
// needs them reports them.
std::string SceneHash(const Description&);

}  // namespace lull
