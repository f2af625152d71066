#include "renderer/input/gltf/variants.h"

#include "renderer/input/gltf/choice.h"

namespace lull {
namespace {

constexpr const char* kExtension = "KHR_materials_variants";

}  // namespace

std::vector<std::string> VariantNames(const GltfDocument& document) {
    std::vector<std::string> names;
    const auto extension = document.model.extensions.find(kExtension);
    if (extension == document.model.extensions.end()) return names;
    const tinygltf::Value& variants = extension->second.Get("variants");
    for (size_t i = 0; i < variants.ArrayLen(); ++i)
        names.push_back(variants.Get(i).Get("name").Get<std::string>());
    return names;
}

void UseVariant(const std::string& wanted, GltfDocument* document) {
    const auto variant = int(ChooseByName(*document, "variant", VariantNames(*document), wanted));
    const auto isMeant = [&](const tinygltf::Value& mapping) {
        const tinygltf::Value& variants = mapping.Get("variants");
        for (size_t i = 0; i < variants.ArrayLen(); ++i)
            if (variants.Get(i).GetNumberAsInt() == variant) return true;
        return false;
    };
    for (tinygltf::Mesh& mesh : document->model.meshes)
        for (tinygltf::Primitive& primitive : mesh.primitives) {
            const auto extension = primitive.extensions.find(kExtension);
            if (extension == primitive.extensions.end()) continue;
            const tinygltf::Value& mappings = extension->second.Get("mappings");
            for (size_t i = 0; i < mappings.ArrayLen(); ++i)
                if (isMeant(mappings.Get(i)))
                    primitive.material = mappings.Get(i).Get("material").GetNumberAsInt();
        }
}

}  // namespace lull
