// Places shapes that are intersected in their own space.
#pragma once

#include "renderer/input/description.h"
#include "renderer/scene/geometry/shapes/quadric.h"

namespace lull {

bool Mirrors(const Mat4d& m);

// Removes the uniform scale from a transform and returns it; the sizes of the shape are to be
// multiplied by it. A transform that stretches stays unchanged: nothing is returned.
std::optional<float> TakeScale(Mat4d* m);

// Returns the placement of a shape without its scale, which goes to *scale: sampling computes a
// shape's area and the cone that it subtends from its sizes. Throws Error if an emitting shape is
// stretched.
QuadricPlacement PlacementOf(const ShapeEntity&, float* scale);

}  // namespace lull
