// Finds the materials that a glTF file has under other names (KHR_materials_variants).
#pragma once

#include <string>
#include <vector>

#include "renderer/input/gltf/document.h"

namespace lull {

// Lists the names of a file's variants, in its order.
std::vector<std::string> VariantNames(const GltfDocument&);

// Gives all primitives the materials that they have in the variant of that name or number, from 0;
// those that it does not name keep their own. Throws Error if there is none such.
void UseVariant(const std::string& wanted, GltfDocument*);

}  // namespace lull
