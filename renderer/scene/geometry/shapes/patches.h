// Makes meshes of parametric surfaces.
#pragma once

#include "renderer/input/description.h"

namespace lull {

// Spans "nu" by "nv" heights "Pz" over the unit square, two triangles per cell. Throws Error with
// file and line if the counts do not agree or a height is not finite.
MeshData HeightfieldMesh(const ShapeEntity&);

// Evaluates a rational B-spline surface (Piegl and Tiller 1997) at 30x30 points between "u0", "u1",
// "v0" and "v1", as pbrt-v3 does, and joins them by triangles with the surface's normals. Throws
// Error with file and line for orders below 2, and counts, knots or ranges that do not agree.
MeshData NurbsMesh(const ShapeEntity&);

}  // namespace lull
