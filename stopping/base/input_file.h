// Opens the files that a user names, and quotes their contents.
#pragma once

#include <fstream>
#include <string>
#include <string_view>

namespace lull {

// Returns why a path cannot be read as a file: it is missing, a directory, or special (a FIFO would
// be waited for, and a device may have no end). Empty: it is a regular file.
std::string ReasonNotToRead(const std::string& path);

// Returns whether there is a file, or anything else, at a path. Throws std::runtime_error, "PATH:
// REASON", where that cannot be told: the name is too long, or a folder cannot be searched.
bool IsThere(const std::string& path);

// Opens a regular file for reading, its bytes as they are. Throws std::runtime_error, "PATH:
// REASON".
std::ifstream OpenInput(const std::string& path);

// Returns untrusted text for a message: control and non-ASCII bytes as \xNN, and "..." in place of
// all behind the first `most` bytes.
std::string Printable(std::string_view text, size_t most = 60);

}  // namespace lull
