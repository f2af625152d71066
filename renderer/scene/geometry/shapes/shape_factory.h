// Makes shapes from their directives: the table of shape kinds.
#pragma once

#include "renderer/input/description.h"
#include "renderer/scene/geometry/shape.h"

namespace lull {

// Makes a shape with its material and alpha textures; its lights come later. Throws Error with
// file and line. An empty mesh substitutes an unknown kind and a mesh that cannot be read.
Shape MakeShape(const Description&, const ShapeEntity&, const TextureTable&, Warnings&);

}  // namespace lull
