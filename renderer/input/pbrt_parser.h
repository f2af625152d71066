// Reads pbrt-v3 scene files.
#pragma once

#include <string>

#include "renderer/base/error.h"
#include "renderer/input/description.h"

namespace lull {

struct ParseOptions {
    // Leaves out what is not modelled (media, motion) with a counted warning instead of an error.
    // Media need it only with the integrators that look at them; the others ignore media in pbrt-v3
    // as well, so that is a warning at all times.
    bool substitute = false;
};

// Reads the scene in `file` and the files it includes; relative names in them start at the
// directory of `file`. Parameters of plug-ins are not judged here. A shape's material is always a
// valid index: a plain "matte" is added where a shape comes before any material. Throws Error,
// with file and line, at whatever is wrong or not modelled.
Description ParsePbrt(const std::string& file, const ParseOptions& options, Warnings& warnings);

}  // namespace lull
