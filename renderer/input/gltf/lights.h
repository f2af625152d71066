// Converts punctual lights of glTF (KHR_lights_punctual) to lights of a Description.
#pragma once

#include "renderer/input/description.h"
#include "renderer/input/gltf/document.h"
#include "renderer/input/gltf/nodes.h"

namespace lull {

// Lumens per watt at 555 nm (CIE), which convert photometric units to radiometric ones.
inline constexpr double kLumensPerWatt = 683;

// Adds the light of a node, if it has one. The specification's lux and candela are divided by
// kLumensPerWatt, as exporters multiply by it. Throws Error.
void AddLight(const GltfDocument&, const GltfNode&, Description*, Warnings&);

}  // namespace lull
