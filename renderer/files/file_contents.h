// Reads files whole.
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "renderer/base/error.h"
#include "stopping/base/input_file.h"

namespace lull {

struct FileContents {
    std::unique_ptr<char[]> bytes;
    size_t size = 0;

    std::string_view View() const { return {bytes.get(), size}; }
};

// Reads the regular file `path` in one go. Throws Error, beginning with `loc` (the place that names
// the file), if it is missing, a directory, or cannot be read.
FileContents ReadFile(const std::string& path, const FileLoc& loc = {});

}  // namespace lull
