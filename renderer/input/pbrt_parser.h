// Reads pbrt-v3 scene files.
#pragma once

#include <string>

#include "renderer/base/error.h"
#include "renderer/input/description.h"

namespace lull {

// Reads the scene in `file` and the files it includes; relative names in them start at the
// directory of `file`. Parameters of plug-ins are not checked here. A shape's material is always a
// valid index: a plain "matte" is added if a shape comes before any material. Throws Error, with
// file and line, for wrong or unsupported directives, of all of them at once (see
// Warnings::ThrowErrors). Missing names and files have substitutes: without these, the errors are
// left in `warnings` for Compile() to add its own.
Description ParsePbrt(const std::string& file, Warnings& warnings);

}  // namespace lull
