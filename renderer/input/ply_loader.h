// Reads triangle meshes from PLY files.
#pragma once

#include <string>

#include "renderer/base/error.h"
#include "renderer/input/description.h"

namespace lull {

// Reads the PLY file `path`: ASCII or binary of either byte order, plain or gzip'd. Of element
// "vertex" it takes x y z, nx ny nz, and u v (also s t, texture_u texture_v, texture_s texture_t)
// in any order and type; of "face" the list vertex_indices (or vertex_index), face_indices, and the
// list texcoord (or another name that means it): two coordinates for each corner, which replace
// those of vertices. A vertex whose corners have several becomes as many vertices. Quads 0123
// become 012 and 023. Strips are the lists of that name of "tristrips". Faces with other counts are
// skipped and normals or uvs that are not finite become 0, each with a counted warning. `loc` is
// named for a file that cannot be read; all other errors name the PLY file. Throws Error for
// malformed or truncated files, used vertices that are not finite, indices out of range, and files
// that declare no faces; a mesh without triangles comes with a warning.
MeshData LoadPly(const std::string& path, Warnings& warnings, const FileLoc& loc = {});

}  // namespace lull
