#include "renderer/scene/scene_names.h"

#include <filesystem>

namespace lull {
namespace {

// Returns where an entity is, for those without a name.
std::string Place(const FileLoc& loc) {
    std::string prefix = loc.Prefix();
    if (prefix.ends_with(": ")) prefix.resize(prefix.size() - 2);
    return prefix;
}

std::string Joined(const std::string& what, const std::string& place) {
    return place.empty() ? what : what + ", " + place;
}

}  // namespace

std::string GivenName(const ShapeEntity& shape) {
    if (!shape.label.empty()) return shape.label;
    return std::filesystem::path(shape.parameters.GetString("filename", "")).stem().string();
}

std::string NameOfObject(uint32_t number, const Description& description, const Scene& scene) {
    const size_t i = number - 1, shapes = description.shapes.size();
    if (i < shapes) {
        const ShapeEntity& shape = description.shapes[i];
        const std::string given = GivenName(shape);
        return given.empty() ? Joined(shape.name, Place(shape.loc)) : given;
    }
    if (i - shapes >= scene.shapes.instances.size()) return "";
    const InstanceEntity& instance =
        description.instances[size_t(scene.shapes.instances[i - shapes].entity)];
    return instance.label.empty() ? description.objects[size_t(instance.object)].name
                                  : instance.label;
}

std::string NameOfMaterial(uint32_t number, const Description& description) {
    if (number > description.materials.size()) return "";
    const MaterialEntity& material = description.materials[number - 1];
    if (!material.materialName.empty()) return material.materialName;
    return Joined(material.name.empty() ? "none" : material.name, Place(material.loc));
}

}  // namespace lull
