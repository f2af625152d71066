#include "renderer/scene/light_groups.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <zlib.h>

#include <algorithm>
#include <filesystem>

#include "renderer/scene/lights/light_sample.h"
#include "renderer/scene/scene.h"
#include "stopping/base/input_file.h"

namespace lull {

namespace {

constexpr const char* kArea = "area";
constexpr const char* kRest = "rest";
constexpr const char* kEach = "each";
constexpr size_t kMostListed = 10;

using Names = std::vector<std::string>;

// Suns are of one kind, whatever their size.
const char* KindOf(const Light& light) {
    if (std::holds_alternative<InfiniteLight>(light)) return "environment";
    return std::holds_alternative<AreaLight>(light) ? kArea : "delta";
}

bool Has(const Names& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
}

void AddNew(const std::string& name, Names* names) {
    if (!name.empty() && !Has(*names, name)) names->push_back(name);
}

Names NamesOfEmitter(const ShapeEntity& shape, const Description& description) {
    Names names;
    AddNew(LightGroupOf(*shape.areaLight), &names);
    AddNew(GivenName(shape), &names);
    if (shape.material >= 0)
        AddNew(description.materials[size_t(shape.material)].materialName, &names);
    AddNew(kArea, &names);
    return names;
}

// Lights with the same names: consecutive ones of the table.
struct NamedLights {
    Names names;  // the most specific first; not empty
    int count;
};

std::vector<NamedLights> ListLights(const Description& description, const Scene& scene) {
    std::vector<NamedLights> lights;
    for (const int entity : scene.lights.Entities()) {
        const LightEntity& light = description.lights[size_t(entity)];
        Names names;
        AddNew(LightGroupOf(light), &names);
        AddNew(light.label, &names);
        AddNew(KindOf(scene.lights[int(lights.size())]), &names);
        lights.push_back({std::move(names), 1});
    }
    for (int i = 0; i < scene.shapes.worldShapeCount; ++i) {
        const Shape& shape = scene.shapes.shapes[size_t(i)];
        if (shape.firstLight >= 0)
            lights.push_back({NamesOfEmitter(description.shapes[size_t(i)], description),
                              int(shape.PrimitiveCount())});
    }
    return lights;
}

void CheckNames(const Names& wanted, const std::vector<NamedLights>& lights) {
    Names known;
    for (const NamedLights& light : lights)
        for (const std::string& name : light.names) AddNew(name, &known);
    for (const std::string& name : wanted) {
        if (name == kRest)
            throw Error(
                "light group \"{}\": the layer of all other lights has this name; leave it out",
                kRest);
        if (Has(known, name)) continue;
        if (known.empty())
            throw Error("light group \"{}\": the scene has no lights; leave the groups out",
                        Printable(name));
        Names listed;
        for (size_t i = 0; i < std::min(known.size(), kMostListed); ++i)
            listed.push_back(Printable(known[i]));
        throw Error(
            "light group \"{}\": no light, object or material of a light has this name; there are: "
            "{}{}",
            Printable(name), fmt::join(listed, ", "),
            known.size() > kMostListed ? fmt::format(", and {} more", known.size() - kMostListed)
                                       : "");
    }
}

Names FirstNamesOf(const std::vector<NamedLights>& lights) {
    Names names;
    for (const NamedLights& light : lights)
        if (light.names.front() != kRest) AddNew(light.names.front(), &names);
    return names;
}

std::string Place(const FileLoc& loc) {
    std::string prefix = loc.Prefix();
    if (prefix.ends_with(": ")) prefix.resize(prefix.size() - 2);
    return prefix;
}

std::string Joined(const std::string& what, const std::string& place) {
    return place.empty() ? what : what + ", " + place;
}

}  // namespace

LightGroups MakeLightGroups(const std::vector<std::string>& wanted, const Description& description,
                            const Scene& scene) {
    const std::vector<NamedLights> lights = ListLights(description, scene);
    LightGroups groups;
    if (wanted == Names{kEach}) {
        groups.names = FirstNamesOf(lights);
    } else {
        CheckNames(wanted, lights);
        for (const std::string& name : wanted) AddNew(name, &groups.names);
    }
    if (groups.Count() > kMostLightGroups)
        throw Error(
            "{} light groups are more than the {} that an image can have; name fewer, or a kind: "
            "environment, area, delta",
            groups.Count(), kMostLightGroups);
    const int rest = groups.Count();
    for (const NamedLights& light : lights) {
        int group = rest;
        for (auto name = light.names.begin(); name != light.names.end() && group == rest; ++name)
            group = int(std::ranges::find(groups.names, *name) - groups.names.begin());
        groups.ofLight.insert(groups.ofLight.end(), size_t(light.count), uint8_t(group));
    }
    if (scene.mediaEmit) groups.ofLight.push_back(uint8_t(rest));
    if (std::ranges::find(groups.ofLight, rest) != groups.ofLight.end() || rest == 0)
        groups.names.push_back(kRest);
    return groups;
}

std::string NameOf(const LightGroups& groups) {
    return fmt::format("{}", fmt::join(groups.names, ","));
}

std::string TextOf(const LightGroups& groups) {
    const uLong sum = crc32_z(crc32_z(0, nullptr, 0), groups.ofLight.data(), groups.ofLight.size());
    return fmt::format("{} of lights crc32:{:08x}", NameOf(groups), uint32_t(sum));
}

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
