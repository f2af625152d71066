// Chooses the view of a glTF file.
#pragma once

#include <optional>
#include <string>

#include "renderer/input/description.h"
#include "renderer/input/gltf/document.h"
#include "renderer/input/gltf/nodes.h"
#include "renderer/input/gltf_loader.h"

namespace lull {

// Sets camera and film: to the camera that the options name, to the first one of the scene, or to
// one that shows all of `bounds`. The height is 800 pixels. Throws Error for a camera that is not
// there or that sees nothing.
void SetView(const GltfDocument&, const std::vector<GltfNode>&, const Bounds3f& bounds,
             const GltfOptions&, Description*);

}  // namespace lull
