#include "renderer/input/gltf/visibility.h"

#include <fmt/format.h>

#include "renderer/input/gltf/parameters.h"

namespace lull {

GltfVisibility VisibilityOf(const GltfDocument& document, int node) {
    const tinygltf::Value& extras = document.model.nodes[size_t(node)].extras;
    const auto isTrue = [&](const char* name) {
        return OwnFlag(document, extras, name, fmt::format("/nodes/{}", node));
    };
    return {isTrue("hiddenFromCamera"), isTrue("castsNoShadow")};
}

void HideShape(const GltfVisibility& visibility, ShapeEntity* shape) {
    const ParameterWriter write(&shape->parameters, shape->loc);
    if (visibility.hiddenFromCamera) write.Bool("hiddenfromcamera", true);
    if (visibility.castsNoShadow) write.Bool("castsnoshadow", true);
}

}  // namespace lull
