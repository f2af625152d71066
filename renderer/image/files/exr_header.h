// Looks through the header of an OpenEXR file before the library does.
#pragma once

#include <cstddef>
#include <span>

namespace lull {

// Throws std::runtime_error if the header is cut short, an attribute claims to be longer than the
// rest of the file, or the list of channels is not as long as it claims, so that the rest would be
// misread: the library would allocate as much, up to 2 GB, before it reads.
void CheckExrHeader(std::span<const std::byte> file);

}  // namespace lull
