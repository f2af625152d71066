// Recognises files that are given for pbrt-v3 scenes and are not.
#pragma once

#include <string>
#include <string_view>

namespace lull {

// Returns the format of a file, and the remedy, if its name or first bytes are of a known format or
// not text at all; "" if it may be a pbrt scene.
std::string ForeignFormat(std::string_view name, std::string_view bytes);

// Returns the version of pbrt for which a scene is written, if a directive shows that it is another
// than pbrt-v3: one that pbrt-v3 does not have, or one with a `kind`, such as a material's, that
// only pbrt-v4 has; "" otherwise.
std::string OtherVersion(std::string_view directive, std::string_view kind);

}  // namespace lull
