// Makes shapes from their directives: the table of shape kinds.
#pragma once

#include "renderer/input/description.h"
#include "renderer/scene/geometry/shape.h"
#include "renderer/scene/geometry/shapes/curves.h"
#include "renderer/scene/geometry/shapes/quadric.h"

namespace lull {

// Makes a shape with its material and alpha textures; its lights come later. Throws Error with
// file and line. An empty mesh substitutes an unknown kind and a mesh that cannot be read.
Shape MakeShape(const Description&, const ShapeEntity&, const TextureTable&, Warnings&);

// Reads Shape "curve" and its further strands: Bezier curves and uniform B-splines of degree 2 and
// 3, of type flat, cylinder or ribbon. Curves without length are skipped with a counted warning.
// Throws Error with file and line if counts of points or normals do not fit, a number is not
// finite, a width is negative, a name is unknown, or the curve should emit light.
Curves ReadCurves(const ShapeEntity&, Warnings&);

// Spans "nu" by "nv" heights "Pz" over the unit square, two triangles per cell. Throws Error with
// file and line if the counts do not agree or a height is not finite.
MeshData HeightfieldMesh(const ShapeEntity&);

// Evaluates a rational B-spline surface (Piegl and Tiller 1997) at 30x30 points between "u0", "u1",
// "v0" and "v1", as pbrt-v3 does, and joins them by triangles with the surface's normals. Throws
// Error with file and line for orders below 2, and counts, knots or ranges that do not agree.
MeshData NurbsMesh(const ShapeEntity&);

bool Mirrors(const Mat4d& m);

// Removes the uniform scale from a transform and returns it; the sizes of the shape are to be
// multiplied by it. A transform that stretches stays unchanged: nothing is returned.
std::optional<float> TakeScale(Mat4d* m);

// Returns the placement of a shape without its scale, which goes to *scale: sampling computes a
// shape's area and the cone that it subtends from its sizes. Throws Error for a stretched emitter.
QuadricPlacement PlacementOf(const ShapeEntity&, float* scale);

}  // namespace lull
