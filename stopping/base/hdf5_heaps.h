// Finds damage to HDF5 files that the library does not detect.
#pragma once

#include <cstdio>

namespace lull {

// Throws std::runtime_error if an object in a global heap of the file, where texts of variable
// length are kept, has no end: up to version 1.14 the library searches behind it for ever. Heaps
// are found by their signature ("HDF5 File Format Specification", III.E), lengths have 8 bytes, as
// writers have them by default. Leaves the position anywhere.
void CheckGlobalHeaps(std::FILE* file);

}  // namespace lull
