// Opens images in formats that the program does not read by itself, by the module of OpenImageIO.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "renderer/formats/formats.h"

namespace lull {

// Opens the file `path` or, if there are bytes, these, whose format is named by the extension of
// `path`. The first call loads the module, which takes 0.2 s. Throws std::runtime_error with the
// reason, without the path: the module is not there, or it cannot read the file.
std::unique_ptr<ImageFile> OpenOtherFormat(const std::string& path,
                                           std::span<const std::byte> bytes = {});

// Returns a function of the module by its name. The first call loads the module, which takes 0.2 s.
// Throws std::runtime_error if it cannot be loaded: `purpose` is the beginning of the message.
void* ModuleFunction(const char* name, const char* purpose);

}  // namespace lull
