// Recognises files that are given for pbrt-v3 scenes and are not.
#pragma once

#include <string>
#include <string_view>

namespace lull {

// Returns the format of a file, and the remedy, if its name or first bytes are of a known format or
// not text at all; "" if it may be a pbrt scene.
std::string ForeignFormat(std::string_view name, std::string_view bytes);

}  // namespace lull
