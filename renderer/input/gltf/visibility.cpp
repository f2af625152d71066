#include "renderer/input/gltf/visibility.h"

#include <fmt/format.h>

#include "renderer/input/gltf/parameters.h"

namespace lull {

GltfVisibility VisibilityOf(const GltfDocument& document, const tinygltf::Value& extras,
                            const std::string& path) {
    return {OwnFlag(document, extras, "hiddenFromCamera", path),
            OwnFlag(document, extras, "castsNoShadow", path)};
}

GltfVisibility VisibilityOf(const GltfDocument& document, int node) {
    return VisibilityOf(document, document.model.nodes[size_t(node)].extras,
                        fmt::format("/nodes/{}", node));
}

void Hide(const GltfVisibility& visibility, Parameters* parameters) {
    const ParameterWriter write(parameters, {});
    if (visibility.hiddenFromCamera) write.Bool("hiddenfromcamera", true);
    if (visibility.castsNoShadow) write.Bool("castsnoshadow", true);
}

}  // namespace lull
