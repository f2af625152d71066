// Poses the nodes of a glTF file by its animations.
#pragma once

#include <string>
#include <vector>

#include "renderer/input/gltf/document.h"
#include "renderer/input/gltf/nodes.h"
#include "renderer/input/gltf/primitives.h"
#include "renderer/input/gltf_loader.h"

namespace lull {

// Lists the nodes as the options pose them: by an animation while the shutter is open, or as in the
// file, with a warning if there are animations. Joints and weights have their values at the opening
// of the shutter, with a warning. Throws as PoseAt() and ListNodes() do.
std::vector<GltfNode> PoseNodes(const GltfOptions&, GltfDocument*, Warnings&);

// Gives all nodes that an animation moves the transforms and weights that it has at a time in
// seconds, as if the file held these; before its first key and after its last one it stands still.
// `wanted` is the name or the number, from 0, of an animation; empty: all together, with a warning
// if some move the same, of which the first counts. Throws Error if there is none of that name, or
// for keys that are wrong.
void PoseAt(double seconds, const std::string& wanted, GltfDocument*, Warnings&);

// Poses meshes by the joints of their skins (3.7.3 of glTF's specification).

// Returns for each joint of a skin the transform of vertices from the bind pose to the world.
// Throws Error for a joint that is not in the scene, or too few inverse bind matrices.
std::vector<Mat4d> JointMatrices(const GltfDocument&, const std::vector<GltfNode>&, int skin);

// Moves the vertices of a primitive, their normals and tangents by their joints into the world.
// Weights are normalised by their sum; vertices without any are moved by the first joint. Throws
// Error for a primitive without joints, and for joints that the skin does not have.
void Skin(const GltfDocument&, int mesh, int primitive, const std::vector<Mat4d>& joints,
          GltfTriangles* triangles);

}  // namespace lull
