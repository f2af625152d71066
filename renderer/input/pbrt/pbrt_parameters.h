// Reads the parameter lists of pbrt-v3 directives.
#pragma once

#include <map>
#include <string>

#include "renderer/input/description.h"
#include "renderer/input/pbrt/pbrt_lexer.h"
#include "renderer/input/pbrt/pbrt_state.h"

namespace lull {

// Context of a parameter: the textures named so far, spectrum files.
struct ParameterContext {
    ScopedNames floatTextures, spectrumTextures;
    std::string directory;               // where the names of spectrum files start
    std::map<std::string, Rgb> spectra;  // already read, by path
};

// Reads `"type name" value` and `"type name" [values]` until something else comes. Throws Error at
// the place of whatever is wrong; warns about integers with a fraction, which is dropped.
Parameters ReadParameters(PbrtLexer& lexer, ParameterContext& context, Warnings& warnings);

}  // namespace lull
