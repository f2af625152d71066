// Lets files be read that break the specification where that does no harm, as exporters do.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "renderer/base/error.h"

namespace lull {

// Changes JSON of which nothing has been checked but its depth, and returns whether it has. With a
// warning of each kind:
//   - members that are null, outside of extras, are absent, as is an attenuationDistance of 0;
//   - meshes without primitives have none, and primitives without vertices, or without indices
//     where they have an accessor of them, are left out.
// Silently: accessors, views and buffers without a byte, and buffers that nothing reads, whose
// files may be missing, stand for a byte of 0.
bool RepairGltfJson(const std::string& file, nlohmann::json* root, Warnings& warnings);

}  // namespace lull
