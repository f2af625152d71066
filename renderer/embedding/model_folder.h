// Finds the installed models from within a library that may have been moved.
#pragma once

#include <string>

namespace lull {

// Returns the folder of installed models: $LULL_MODELS if that is set and not empty, else the one
// relative to this library as installed.
std::string InstalledModels();

}  // namespace lull
