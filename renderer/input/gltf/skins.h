// Poses meshes by the joints of their skins (3.7.3 of glTF's specification).
#pragma once

#include "renderer/input/gltf/nodes.h"
#include "renderer/input/gltf/primitives.h"

namespace lull {

// Returns for each joint of a skin the transform of vertices from the bind pose to the world.
// Throws Error for a joint that is not in the scene, or too few inverse bind matrices.
std::vector<Mat4d> JointMatrices(const GltfDocument&, const std::vector<GltfNode>&, int skin);

// Moves the vertices of a primitive, their normals and tangents by their joints into the world.
// Weights are normalised by their sum; vertices without any are moved by the first joint. Throws
// Error for a primitive without joints, and for joints that the skin does not have.
void Skin(const GltfDocument&, int mesh, int primitive, const std::vector<Mat4d>& joints,
          GltfTriangles* triangles);

}  // namespace lull
