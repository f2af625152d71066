// Recognises files that are given for pbrt-v3 scenes and are not.
#pragma once

#include <string>
#include <string_view>

namespace lull {

// Returns the format of a file, and the remedy, if its first bytes are of a known format or not
// text at all; "" if it may be a pbrt scene.
std::string ForeignFormat(std::string_view bytes);

// Returns whether a directive shows that a scene is written for pbrt-v4: one that pbrt-v3 does not
// have, or one of both with a `kind`, such as a material's, that only pbrt-v4 has.
bool IsPbrtV4(std::string_view directive, std::string_view kind);

}  // namespace lull
