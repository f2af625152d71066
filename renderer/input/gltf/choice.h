// Selects entries of a glTF file by name or number.
#pragma once

#include <string>
#include <vector>

#include "renderer/input/gltf/document.h"

namespace lull {

// Writes names with their numbers: 0 "red", 1 "blue"; "none" where there are none.
std::string NumberedNames(const std::vector<std::string>& names);

// Returns the index of the first of `names` equal to `wanted`, or the index that `wanted` is, from
// 0. Throws Error with a list of them where there is none; `what` is their noun: "camera".
size_t ChooseByName(const GltfDocument&, const std::string& what,
                    const std::vector<std::string>& names, const std::string& wanted);

}  // namespace lull
