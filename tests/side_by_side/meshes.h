// Turns lull's shapes into triangles for glTF.
#pragma once

#include "renderer/scene/geometry/shape_table.h"

namespace lull {

// A mesh as glTF wants it: unit normals or none, v growing downwards, triangles
// counterclockwise as seen from the side of the normal.
struct GltfMesh {
    std::vector<Vec3f> positions, normals;
    std::vector<Vec2f> uvs;
    std::vector<std::array<uint32_t, 3>> triangles;
};

// Triangulates a shape and transforms it by `m`, which may mirror. Spheres and disks become 64 by
// 32 and 64 patches; clipped spheres are treated as whole. Curves give nothing.
GltfMesh MakeGltfMesh(const Shape& shape, const Mat4d& m);

}  // namespace lull
