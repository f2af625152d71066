#include "renderer/image/files/other_formats.h"

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

std::unique_ptr<ImageFile> OpenOtherFormat(const std::string& path,
                                           std::span<const std::byte> bytes) {
    static auto* const open = reinterpret_cast<OpenImageFunction*>(ModuleFunction(
        "LullOpenImage",
        "it is neither PNG nor OpenEXR, and all other formats are read by the module"));
    return std::unique_ptr<ImageFile>(open(path.c_str(), bytes.data(), bytes.size()));
}

}  // namespace lull
