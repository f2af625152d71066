// Unpacks gzip'd files.
#pragma once

#include "renderer/base/error.h"
#include "renderer/files/file_io.h"

namespace lull {

// Returns `contents` unpacked if they are gzip'd, as they are otherwise. Throws Error at `loc` if
// they are damaged, or unpack to more than any mesh has.
FileContents Inflated(FileContents contents, const FileLoc& loc);

}  // namespace lull
