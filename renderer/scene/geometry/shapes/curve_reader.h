// Makes curves from their directives.
#pragma once

#include "renderer/input/description.h"
#include "renderer/scene/geometry/shapes/curves.h"

namespace lull {

// Reads Shape "curve" and its further strands: Bezier curves and uniform B-splines of degree 2 and
// 3, of type flat, cylinder or ribbon. Curves without length are skipped with a counted warning.
// Throws Error with file and line if counts of points or normals do not fit, a number is not
// finite, a width is negative, a name is unknown, or the curve should emit light.
Curves ReadCurves(const ShapeEntity&, Warnings&);

}  // namespace lull
