#include "renderer/measure/extra_layers.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <set>

namespace lull {

namespace {

// Says where an entity is, for those without a name.
std::string Place(const FileLoc& loc) {
    std::string prefix = loc.Prefix();
    if (prefix.ends_with(": ")) prefix.resize(prefix.size() - 2);
    return prefix;
}

std::string Joined(const std::string& what, const std::string& place) {
    return place.empty() ? what : what + ", " + place;
}

std::string NameOfShape(const ShapeEntity& shape) {
    if (!shape.label.empty()) return shape.label;
    const std::string file = shape.parameters.GetString("filename", "");
    return file.empty() ? Joined(shape.name, Place(shape.loc))
                        : std::filesystem::path(file).stem().string();
}

// The numbers are those of FirstHit. A checkpoint that somebody has changed can have others.
std::string NameOfObject(uint32_t number, const Description& description, const Scene& scene) {
    const size_t i = number - 1, shapes = description.shapes.size();
    if (i < shapes) return NameOfShape(description.shapes[i]);
    if (i - shapes >= scene.shapes.instances.size()) return "";
    return description.objects[size_t(scene.shapes.instances[i - shapes].object)].name;
}

std::string NameOfMaterial(uint32_t number, const Description& description) {
    if (number > description.materials.size()) return "";
    const MaterialEntity& material = description.materials[number - 1];
    if (!material.materialName.empty()) return material.materialName;
    return Joined(material.name.empty() ? "none" : material.name, Place(material.loc));
}

template <typename Name>
std::string NamesOf(const AovFilm& aovs, uint32_t AovPixel::*number, const Name& name) {
    std::set<uint32_t> numbers;
    for (const AovPixel& pixel : aovs.Pixels()) numbers.insert(pixel.*number);
    numbers.erase(0);
    nlohmann::ordered_json names = nlohmann::ordered_json::object();
    for (const uint32_t n : numbers) names[std::to_string(n)] = name(n);
    return names.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace

ExtraLayers MakeExtraLayers(const AovFilm& aovs, const Film& film, const Description& description,
                            const Scene& scene) {
    const AovSet& wanted = aovs.Wanted();
    ExtraLayers extra{MakeAovChannels(aovs, film), {{"aov", TextOf(wanted)}}};
    if (wanted.object)
        extra.attributes["objectNames"] = NamesOf(aovs, &AovPixel::object, [&](uint32_t n) {
            return NameOfObject(n, description, scene);
        });
    if (wanted.material)
        extra.attributes["materialNames"] = NamesOf(
            aovs, &AovPixel::material, [&](uint32_t n) { return NameOfMaterial(n, description); });
    return extra;
}

}  // namespace lull
