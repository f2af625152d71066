// Reads the parameter lists of pbrt's directives.
#pragma once

#include <map>
#include <string>

#include "renderer/input/description.h"
#include "renderer/input/pbrt/pbrt_lexer.h"
#include "renderer/input/pbrt/pbrt_state.h"
#include "renderer/input/pbrt/pbrt_version.h"

namespace lull {

// Context of a parameter: the textures named so far, spectrum files.
struct ParameterContext {
    PbrtVersion version = PbrtVersion::V3;
    Mat3f rgbFromColorSpace = Mat3f::Identity();  // linear sRGB from pbrt-v4's ColorSpace
    ScopedNames floatTextures, spectrumTextures;
    std::string directory;               // where the names of spectrum files start
    std::map<std::string, Rgb> spectra;  // already read, by path
};

// Reads `"type name" value` and `"type name" [values]` until something else comes. Throws Error at
// the place of whatever is wrong; warns about integers with a fraction, which pbrt-v3 drops and
// pbrt-v4 refuses.
Parameters ReadParameters(PbrtLexer& lexer, ParameterContext& context, Warnings& warnings);

}  // namespace lull
