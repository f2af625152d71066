#include "renderer/image/files/other_formats.h"

#include "renderer/image/files/formats_module.h"

namespace lull {

std::unique_ptr<ImageFile> OpenOtherFormat(const std::string& path,
                                           std::span<const std::byte> bytes) {
    static auto* const open = reinterpret_cast<OpenImageFunction*>(ModuleFunction(
        "LullOpenImage",
        "it is neither PNG nor OpenEXR, and all other formats are read by the module"));
    return std::unique_ptr<ImageFile>(open(path.c_str(), bytes.data(), bytes.size()));
}

}  // namespace lull
