// Identifies the file that a rule has read, in the headers of what was rendered with it.
#pragma once

#include <string>

namespace lull {

// Returns "crc32:" and the CRC-32 of a file in eight hexadecimal digits: it tells mixed-up files
// apart and is no protection against forgery. Throws std::runtime_error if it cannot be read.
std::string FileChecksum(const std::string& path);

}  // namespace lull
