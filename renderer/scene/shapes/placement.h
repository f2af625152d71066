// Reads where shapes stand that are intersected in their own space.
#pragma once

#include "renderer/input/description.h"
#include "renderer/scene/shapes/quadric.h"

namespace lull {

bool Mirrors(const Mat4d& m);

// Takes the scale out of a transform, for the sizes of the shape to be multiplied by, and returns
// it. A transform that stretches is left as it is: nothing is returned.
std::optional<float> TakeScale(Mat4d* m);

// Returns where a shape stands, with its scale taken out into *scale: sampling takes a shape's area
// and the cone that it subtends from its sizes. Throws Error where a shape that emits is stretched.
QuadricPlacement PlacementOf(const ShapeEntity&, float* scale);

}  // namespace lull
