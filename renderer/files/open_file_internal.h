// Names of open files.
#pragma once

#include <string>

namespace lull {

// Returns whether the name is still that of the open file: who had its lock before may have removed
// it or given it another.
bool IsNamed(int fd, const std::string& name);

}  // namespace lull
