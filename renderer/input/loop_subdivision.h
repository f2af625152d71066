// Subdivides triangle meshes by Loop's scheme.
#pragma once

#include <span>

#include "renderer/base/error.h"
#include "renderer/input/description.h"

namespace lull {

// Subdivides `levels` times (each makes four triangles of one; less than 0 counts as 0) and moves
// the vertices to the limit surface. `p` holds xyz triplets, `indices` vertex triplets. As in
// pbrt-v3 (whose default is 3 levels) the normals are the products of the limit tangents, of any
// length, and point against the side from which the triangles run counterclockwise. Vertices that
// no face uses stay where they are, with a zero normal. Throws Error at `loc` for counts that are
// no multiple of 3, no faces, indices out of range, faces that repeat a vertex, edges of more than
// two faces or of two that run the same way, and results beyond 50 million triangles.
MeshData LoopSubdivide(std::span<const float> p, std::span<const int> indices, int levels,
                       const FileLoc& loc);

}  // namespace lull
