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

OpenImageFunction* LoadModule() {
    const std::string path = ModulePath();
    void* module = dlopen(path.c_str(), RTLD_LAZY | RTLD_LOCAL);
    void* function = module ? dlsym(module, "LullOpenImage") : nullptr;
    if (!function)
        throw std::runtime_error(
            fmt::format("it is neither PNG nor OpenEXR, and all other formats are read by \"{}\", "
                        "which cannot be loaded ({}); reinstall lull, or convert the image",
                        path, dlerror()));
    return reinterpret_cast<OpenImageFunction*>(function);
}

}  // namespace

std::unique_ptr<ImageFile> OpenOtherFormat(const std::string& path,
                                           std::span<const std::byte> bytes) {
    static OpenImageFunction* const open = LoadModule();
    return std::unique_ptr<ImageFile>(open(path.c_str(), bytes.data(), bytes.size()));
}

}  // namespace lull
