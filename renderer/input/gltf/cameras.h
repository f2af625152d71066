// Chooses the view of a glTF file.
#pragma once

#include <optional>
#include <string>

#include "renderer/input/description.h"
#include "renderer/input/gltf/document.h"
#include "renderer/input/gltf/framing.h"
#include "renderer/input/gltf/nodes.h"
#include "renderer/input/gltf_loader.h"

namespace lull {

// Returns the framing, to be extended by all points of the scene before SetView(), where the
// options ask for a view of all, or there is no camera; else nothing.
std::optional<Framing> FramingFor(const GltfDocument&, const std::vector<GltfNode>&,
                                  const GltfOptions&);

// Sets camera and film: as framed, to the camera that the options name, or to the first one of the
// scene. The height is 800 pixels. Throws Error for a camera that is not there or that sees
// nothing.
void SetView(const GltfDocument&, const std::vector<GltfNode>&, const std::optional<Framing>&,
             const GltfOptions&, Description*);

}  // namespace lull
