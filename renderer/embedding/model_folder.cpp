#include "renderer/embedding/model_folder.h"

#include <dlfcn.h>

#include <cstdlib>
#include <filesystem>

namespace lull {

std::string InstalledModels() {
    const char* set = std::getenv("LULL_MODELS");
    if (set && *set) return set;
    Dl_info library;
    if (!dladdr(reinterpret_cast<const void*>(&InstalledModels), &library) || !library.dli_fname)
        return LULL_MODELS_FROM_LIBRARY;
    // Links to the library may lie elsewhere.
    std::error_code ignored;
    std::filesystem::path file = std::filesystem::canonical(library.dli_fname, ignored);
    if (ignored) file = library.dli_fname;
    return (file.parent_path() / LULL_MODELS_FROM_LIBRARY).lexically_normal().string();
}

}  // namespace lull
