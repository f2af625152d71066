// Undoes the compression of glTF's meshes.
#pragma once

#include <nlohmann/json_fwd.hpp>

#include "renderer/input/gltf/document.h"

namespace lull {

// Removes unsupported parts from a file's JSON: the indices of primitives
// compressed by Draco, which have no data, and buffers that only stand for data compressed by
// meshopt. Returns whether anything has changed.
bool HideCompressed(nlohmann::json* root);

// Decodes views compressed by EXT_meshopt_compression and primitives compressed by
// KHR_draco_mesh_compression into buffers of their own, so that nothing else needs to know about
// them. Throw Error.
void DecodeMeshopt(GltfDocument*);
void DecodeDraco(GltfDocument*);

}  // namespace lull
