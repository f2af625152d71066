#include "renderer/image/files/formats_module.h"

#include <dlfcn.h>
#include <fmt/core.h>

#include <filesystem>
#include <stdexcept>

namespace lull {

namespace {

// The path from the program to the module is the same in the build tree as where it is installed.
std::string ModulePath() {
    const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe");
    return (program.parent_path().parent_path() / LULL_MODULE_FOLDER / "formats.so").string();
}

}  // namespace

void* ModuleFunction(const char* name, const char* purpose) {
    const std::string path = ModulePath();
    void* module = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
    void* function = module ? dlsym(module, name) : nullptr;
    if (!function)
        throw std::runtime_error(fmt::format(
            "{} \"{}\", which cannot be loaded ({}); reinstall lull", purpose, path, dlerror()));
    return function;
}

}  // namespace lull
