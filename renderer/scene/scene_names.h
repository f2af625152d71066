// Readable names of the objects and materials of a scene.
#pragma once

#include <string>

#include "renderer/scene/compile.h"

namespace lull {

// Return the name of an object or a material by its number (FirstHit), not 0: as the scene has it,
// else kind, file and line. Numbers that the scene does not have, as of a checkpoint that somebody
// has changed, give "".
std::string NameOfObject(uint32_t number, const Description&, const Scene&);
std::string NameOfMaterial(uint32_t number, const Description&);

// Returns the name that the scene gives a shape: its own, else that of its file; can be empty.
std::string GivenName(const ShapeEntity&);

}  // namespace lull
