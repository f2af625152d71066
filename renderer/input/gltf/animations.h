// Poses the nodes of a glTF file by its animations.
#pragma once

#include <string>
#include <vector>

#include "renderer/input/gltf/document.h"
#include "renderer/input/gltf/nodes.h"
#include "renderer/input/gltf_loader.h"

namespace lull {

// Lists the nodes as the options pose them: as an animation has them while the shutter is open, or
// as the file stands, with a warning if there are animations. Joints and weights keep what they
// have when the shutter opens, with a warning. Throws as PoseAt() and ListNodes() do.
std::vector<GltfNode> PoseNodes(const GltfOptions&, GltfDocument*, Warnings&);

// Gives all nodes that an animation moves the transforms and weights that it has at a time in
// seconds, as if the file held these; before its first key and after its last one it stands still.
// `wanted` is the name or the number, from 0, of an animation; empty: all together, with a warning
// if some move the same, of which the first counts. Throws Error if there is none of that name, or
// for keys that are wrong.
void PoseAt(double seconds, const std::string& wanted, GltfDocument*, Warnings&);

}  // namespace lull
