// Makes the triangles that glTF knows of the shapes that lull knows.
#pragma once

#include "renderer/scene/shape_table.h"

namespace lull {

// Holds a mesh as glTF wants it: unit normals or none, v growing downwards, triangles
// counterclockwise as seen from the side of the normal.
struct GltfMesh {
    std::vector<Vec3f> positions, normals;
    std::vector<Vec2f> uvs;
    std::vector<std::array<uint32_t, 3>> triangles;
};

// Triangulates a shape and carries it by `m`, which may mirror. Spheres and disks become 64 by 32
// and 64 patches; clipped spheres are taken as whole. Nothing comes of curves.
GltfMesh MakeGltfMesh(const Shape& shape, const Mat4d& m);

}  // namespace lull
