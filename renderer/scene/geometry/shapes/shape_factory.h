// Makes shapes from their directives: the table of shape kinds.
#pragma once

#include "renderer/input/description.h"
#include "renderer/scene/geometry/shape.h"
#include "renderer/scene/geometry/shapes/quadric.h"

namespace lull {

// Makes a shape with its material and alpha textures; its lights come later. Throws Error with
// file and line. An empty mesh substitutes an unknown kind and a mesh that cannot be read.
Shape MakeShape(const Description&, const ShapeEntity&, const TextureTable&, Warnings&);

// Places shapes that are intersected in their own space.

bool Mirrors(const Mat4d& m);

// Removes the uniform scale from a transform and returns it; the sizes of the shape are to be
// multiplied by it. A transform that stretches stays unchanged: nothing is returned.
std::optional<float> TakeScale(Mat4d* m);

// Returns the placement of a shape without its scale, which goes to *scale: sampling computes a
// shape's area and the cone that it subtends from its sizes. Throws Error if an emitting shape is
// stretched.
QuadricPlacement PlacementOf(const ShapeEntity&, float* scale);

}  // namespace lull
