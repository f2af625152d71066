// Cleans texts of what editors and old programs put around them.
#pragma once

#include <string_view>

#include "renderer/base/error.h"

namespace lull {

// Returns the text without UTF-8's byte-order mark. Throws Error at `loc` for UTF-16 and UTF-32,
// with or without theirs.
std::string_view WithoutByteOrderMark(std::string_view text, const FileLoc& loc);

// Does so, and leaves out Control-Z and NUL at the end, by which old programs mark it.
std::string_view CleanText(std::string_view text, const FileLoc& loc);

}  // namespace lull
