// Makes shapes from their directives: the table of shape kinds.
#pragma once

#include "renderer/input/description.h"
#include "renderer/scene/geometry/shape.h"

namespace lull {

// Makes a shape with its material and alpha textures; its lights come later. Throws Error with
// file and line. With `substitute`, an unknown kind becomes an empty mesh and a counted warning.
Shape MakeShape(const Description&, const ShapeEntity&, const TextureTable&, bool substitute,
                Warnings&);

}  // namespace lull
