// Checks the structure of glTF's JSON before anything is made of it.
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

#include "renderer/base/error.h"

namespace lull {

// Parses JSON. Throws Error with `file` for text that is not JSON, not an object, or nested so
// deeply that reading it could exhaust the stack.
nlohmann::json ParseGltfJson(const std::string& file, std::string_view text);

// Lets files be read that break the specification where that does no harm, as exporters do.
// Changes JSON of which nothing has been checked but its depth. With a warning of each kind:
//   - members that are null, outside of extras, numbers with a null among them, -1 for an index, []
//     for an object and empty texts are absent, as is an attenuationDistance of 0;
//   - meshes without primitives have none; primitives without vertices, or without indices where
//     they have an accessor of them, and attributes without elements are left out, as are textures
//     without an index, skins without joints, animations without keys, copies where there are none,
//     and lights without a type; a spot without angles has the usual ones.
// Silently: accessors, views and buffers without a byte, images that nothing shows, and buffers
// that nothing reads, whose files may be missing, or that only stand for data compressed by
// meshopt, stand for a byte of 0; those compressed by Draco have no indices; cameras clip nothing.
void RepairGltfJson(const std::string& file, nlohmann::json* root, Warnings& warnings);

// Throws Error with `file` and the JSON pointer of the first violation of the specification: types,
// indices between the top-level arrays, enumerations, numbers that fit no float, data URIs that are
// not base64. Warns of factors beyond their range. Writes 4.0 as 4 where integers belong.
void CheckGltfJson(const std::string& file, nlohmann::json* root, Warnings& warnings);

}  // namespace lull
