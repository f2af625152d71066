// Reads scene files of pbrt-v3 and pbrt-v4.
#pragma once

#include <optional>
#include <string>

#include "renderer/base/error.h"
#include "renderer/input/description.h"

namespace lull {

class PbrtLexer;

enum class PbrtVersion { V3, V4 };

// Reads a file, and what it includes, from where the lexer is up to the first directive or
// parameter that only one version has, and rewinds it; `directory` is where names of files start. A
// world without an end is pbrt-v4's. Where there is no such sign it is taken for pbrt-v3's, with a
// warning where a scene for pbrt-v4 would be another one. Throws Error, also for pbrt-v2.
PbrtVersion DetectPbrtVersion(const std::string& directory, PbrtLexer* lexer, Warnings& warnings);

// Reads the scene in `file` and the files it includes; relative names in them start at the
// directory of `file`. The version is DetectPbrtVersion()'s unless it is given; entities of pbrt-v4
// are translated. Parameters of pbrt-v3's plug-ins are not checked here. A shape's material is
// always a valid index: a plain "matte" is added if a shape comes before any material. Throws
// Error, with file and line, for wrong or unsupported directives, of all of them at once (see
// Warnings::ThrowErrors). Missing names and files have substitutes: without these, the errors are
// left in `warnings` for Compile() to add its own.
Description ParsePbrt(const std::string& file, Warnings& warnings,
                      std::optional<PbrtVersion> version = {});

}  // namespace lull
