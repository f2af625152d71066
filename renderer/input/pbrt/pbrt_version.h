// Tells scenes for pbrt-v3 from those for pbrt-v4.
#pragma once

#include <string>

#include "renderer/base/error.h"

namespace lull {

class PbrtLexer;

enum class PbrtVersion { V3, V4 };

// Reads a file, and what it includes, from where the lexer is up to the first directive or
// parameter that only one version has, and rewinds it; `directory` is where names of files start. A
// world without an end is pbrt-v4's. Where there is no such sign it is taken for pbrt-v3's, with a
// warning where a scene for pbrt-v4 would be another one. Throws Error as PbrtLexer does, and for
// scenes for pbrt-v2.
PbrtVersion DetectPbrtVersion(const std::string& directory, PbrtLexer* lexer, Warnings& warnings);

}  // namespace lull
