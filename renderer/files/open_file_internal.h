// Names of open files.
#pragma once

#include <string>

namespace lull {

// Returns whether the name is still of the open file: an earlier holder of its lock may have
// removed or renamed it.
bool IsNamed(int fd, const std::string& name);

}  // namespace lull
