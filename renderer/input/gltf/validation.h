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

// Throws Error with `file` and the JSON pointer of the first violation of the specification: types,
// indices between the top-level arrays, enumerations, numbers that fit no float, data URIs that are
// not base64. Warns of factors beyond their range. Writes whole numbers such as 4.0 as 4 where the
// specification has integers, and returns whether any has changed.
bool CheckGltfJson(const std::string& file, nlohmann::json* root, Warnings& warnings);

}  // namespace lull
