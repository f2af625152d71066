// Finds the scenes and reference data that lie beside the project.
#pragma once

#include <cstdlib>
#include <filesystem>

namespace lull {

// Returns the folder with the shared data; it need not be there.
inline std::filesystem::path SharedFolder() {
    const char* set = std::getenv("LULL_SHARED");
    return set && *set ? set : LULL_SHARED_DIR;
}

}  // namespace lull
