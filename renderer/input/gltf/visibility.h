// Reads our own properties of nodes and materials that say which rays do not see them.
#pragma once

#include "renderer/input/description.h"
#include "renderer/input/gltf/document.h"

namespace lull {

// Rays that pass the mesh of a node, the sphere of its light, or a surface.
struct GltfVisibility {
    bool hiddenFromCamera = false, castsNoShadow = false;

    auto operator<=>(const GltfVisibility&) const = default;
};

// Reads the `extras` of the node or material at the JSON pointer `path`. Throws Error.
GltfVisibility VisibilityOf(const GltfDocument&, const tinygltf::Value& extras,
                            const std::string& path);
GltfVisibility VisibilityOf(const GltfDocument&, int node);

// Adds parameters of a shape.
void Hide(const GltfVisibility&, Parameters*);

}  // namespace lull
