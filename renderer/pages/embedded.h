// Gives access to files that are part of the program (lull_embed() in cmake/EmbedFiles.cmake).
#pragma once

#include <string_view>

namespace lull {

// Returns the text of a file by its name without folder; empty if there is none.
std::string_view EmbeddedFile(std::string_view name);

}  // namespace lull
