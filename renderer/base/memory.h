// Says before memory is taken whether there is enough, since the system would only end the program.
#pragma once

#include <cstdint>
#include <string>

#include "renderer/base/error.h"

namespace lull {

// Returns how many bytes can still be taken: what the system has available, within the limits of
// this process (ulimit -v) and of its group (containers). Very many where that is not known.
int64_t AvailableMemory();

// Throws Error if that is less than `bytes`: "<what> needs 27.0 GB of memory, 11.3 GB are
// available; <remedy>".
void CheckMemory(int64_t bytes, const std::string& what, const std::string& remedy,
                 const FileLoc& loc = {});

}  // namespace lull
