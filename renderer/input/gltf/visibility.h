// Reads our own properties of nodes that say which rays do not see them.
#pragma once

#include "renderer/input/description.h"
#include "renderer/input/gltf/document.h"

namespace lull {

// Rays that pass the mesh of a node, or the sphere of its light.
struct GltfVisibility {
    bool hiddenFromCamera = false, castsNoShadow = false;

    auto operator<=>(const GltfVisibility&) const = default;
};

// Throws Error.
GltfVisibility VisibilityOf(const GltfDocument&, int node);

void HideShape(const GltfVisibility&, ShapeEntity*);

}  // namespace lull
