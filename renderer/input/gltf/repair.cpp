// Lets files be read that break the specification where that does no harm.
#include <algorithm>
#include <optional>
#include <set>
#include <string>

#include "renderer/input/gltf/json_at.h"
#include "renderer/input/gltf/validation.h"

namespace lull {
namespace {

using nlohmann::json;

json* Member(json* value, const char* name) {
    if (!value->is_object()) return nullptr;
    const auto found = value->find(name);
    return found == value->end() ? nullptr : &*found;
}

json* Extension(json* owner, const char* name) {
    json* extensions = Member(owner, "extensions");
    return extensions ? Member(extensions, name) : nullptr;
}

template <typename F>
void ForEachObject(json* owner, const char* name, const F& f) {
    json* array = Member(owner, name);
    if (!array || !array->is_array()) return;
    for (size_t i = 0; i < array->size(); ++i)
        if (array->at(i).is_object()) f(array->at(i), i);
}

bool IsZero(const json* value) { return value && value->is_number() && value->get<double>() == 0; }

// Returns what a member of an object stands for that is as good as absent: null; numbers of which
// one is null, as JSON writes NaN; -1 for no index; an empty text; []. Null: it is none.
const char* NothingIn(const std::string& name, const json& value) {
    constexpr const char* kIndices[] = {
        "bufferView", "camera", "index",   "indices", "inverseBindMatrices",
        "material",   "mesh",   "sampler", "scene",   "skeleton",
        "skin",       "source"};
    constexpr const char* kObjects[] = {"extensions", "pbrMetallicRoughness"};
    constexpr const char* kTexts[] = {"alphaMode", "interpolation", "mimeType", "uri"};
    const auto isOneOf = [&](const auto& names) { return std::ranges::count(names, name) > 0; };
    if (value.is_null()) return "null";
    if (value.is_array() && value.empty() && (isOneOf(kObjects) || name.ends_with("Texture")))
        return "[]";
    if (name == "joints") return nullptr;  // weights count them
    const auto isOf = [&](auto is) { return std::ranges::any_of(value, is); };
    if (value.is_array() && isOf([](const json& v) { return v.is_null(); }) &&
        !isOf([](const json& v) { return !v.is_null() && !v.is_number(); }))
        return "null among numbers";
    if (value == "" && isOneOf(kTexts)) return "\"\"";
    return value == -1 && isOneOf(kIndices) ? "-1" : nullptr;
}

void EraseNothings(const std::string& file, const std::string& path, json* value,
                   Warnings& warnings) {
    if (value->is_array())
        for (size_t i = 0; i < value->size(); ++i)
            EraseNothings(file, path + "/" + std::to_string(i), &value->at(i), warnings);
    if (!value->is_object()) return;
    for (auto it = value->begin(); it != value->end();) {
        if ((it.key() == "children" || it.key() == "nodes") && it->is_array())
            it->erase(std::remove(it->begin(), it->end(), nullptr), it->end());
        if (const char* nothing = NothingIn(it.key(), *it)) {
            warnings.Add(PlaceIn(file, path), nothing + std::string(" counts as absent"),
                         Printable(it.key()));
            it = value->erase(it);
            continue;
        }
        if (it->is_structured() && it.key() != "extras")
            EraseNothings(file, path + "/" + Printable(it.key()), &*it, warnings);
        ++it;
    }
}

std::optional<size_t> IndexOf(const json& value) {
    if (!value.is_number()) return {};
    const auto n = value.get<double>();
    if (!(n >= 0 && n < 1e9)) return {};
    return size_t(n);
}

void Collect(const json& value, const std::string& name, std::set<size_t>* numbers,
             bool isWithin = false) {
    for (const auto& [key, member] : value.items()) {
        const bool counts = isWithin || (value.is_object() && key == name);
        if (const auto index = counts ? IndexOf(member) : std::nullopt) numbers->insert(*index);
        if (member.is_structured()) Collect(member, name, numbers, counts);
    }
}

class Repair {
  public:
    Repair(const std::string& file, json* root, Warnings& warnings)
        : file(file), root(root), warnings(warnings) {}

    void Run() {
        EraseNothings(file, "", root, warnings);
        LeaveOutDistances();
        LeaveOutTextures(file, "", root, warnings);
        LeaveOutPrimitives();
        LeaveOutPoses();
        FillLights();
        FillImages();
        FillCameras();
        FillAccessors();
        FillViews();
    }

  private:
    // three.js wrote infinity as 0 before r145.
    void LeaveOutDistances() {
        ForEachObject(root, "materials", [&](json& material, size_t i) {
            json* volume = Extension(&material, "KHR_materials_volume");
            if (!volume || !IsZero(Member(volume, "attenuationDistance"))) return;
            volume->erase("attenuationDistance");
            warnings.Add(PlaceIn(file, "/materials/" + std::to_string(i)),
                         "an attenuationDistance of 0 counts as absent");
        });
    }

    // Textures are members of that name, all over a material.
    static void LeaveOutTextures(const std::string& file, const std::string& path, json* value,
                                 Warnings& warnings) {
        for (auto it = value->begin(); it != value->end();) {
            const std::string name =
                value->is_object() ? it.key() : std::to_string(it - value->begin());
            if (name.ends_with("Texture") && it->is_object() && !it->contains("index")) {
                warnings.Add(PlaceIn(file, path), "texture without an index is left out",
                             Printable(name));
                it = value->erase(it);
                continue;
            }
            if (it->is_structured() && name != "extras")
                LeaveOutTextures(file, path + "/" + Printable(name), &*it, warnings);
            ++it;
        }
    }

    json* At(const char* array, const json& index) {
        json* all = Member(root, array);
        const std::optional<size_t> i = IndexOf(index);
        return all && all->is_array() && i && *i < all->size() ? &all->at(*i) : nullptr;
    }
    bool IsEmpty(const json& accessor) {
        json* one = At("accessors", accessor);
        if (!one) return false;
        if (IsZero(Member(one, "count"))) return true;
        const json* view = Member(one, "bufferView");
        json* bytes = view ? At("bufferViews", *view) : nullptr;
        return bytes && IsZero(Member(bytes, "byteLength"));
    }
    bool IsEmptyPrimitive(json* primitive) {
        const json* indices = Member(primitive, "indices");
        if (indices && IsEmpty(*indices)) return true;
        json* attributes = Member(primitive, "attributes");
        const json* positions = attributes ? Member(attributes, "POSITION") : nullptr;
        return positions && IsEmpty(*positions);
    }
    void LeaveOutEmpty(json* owner, const FileLoc& loc) {
        if (!owner || !owner->is_object()) return;
        for (auto it = owner->begin(); it != owner->end();)
            if (IsEmpty(*it)) {
                warnings.Add(loc, "attribute without elements is left out", Printable(it.key()));
                it = owner->erase(it);
            } else {
                ++it;
            }
    }
    void LeaveOutPrimitives() {
        ForEachObject(root, "meshes", [&](json& mesh, size_t i) {
            const FileLoc loc = PlaceIn(file, "/meshes/" + std::to_string(i));
            json* primitives = Member(&mesh, "primitives");
            if (!primitives) {
                mesh["primitives"] = json::array();
                warnings.Add(loc, "mesh without primitives is left out");
            } else if (primitives->is_array()) {
                for (auto p = primitives->begin(); p != primitives->end();) {
                    // Their accessor has no data.
                    if (Extension(&*p, "KHR_draco_mesh_compression")) p->erase("indices");
                    if (!IsEmptyPrimitive(&*p)) {
                        LeaveOutEmpty(Member(&*p, "attributes"), loc);
                        ForEachObject(&*p, "targets",
                                      [&](json& target, size_t) { LeaveOutEmpty(&target, loc); });
                        ++p;
                        continue;
                    }
                    p = primitives->erase(p);
                    warnings.Add(loc, "primitive without vertices or indices is left out");
                }
            }
        });
    }
    // Nodes without a pose stay where they are.
    void LeaveOutPoses() {
        std::set<size_t> bare;
        ForEachObject(root, "skins", [&](json& skin, size_t i) {
            const json* matrices = Member(&skin, "inverseBindMatrices");
            if (matrices && IsEmpty(*matrices)) skin.erase("inverseBindMatrices");
            const json* joints = Member(&skin, "joints");
            if (joints && !joints->empty()) return;
            skin["joints"] = {0u};
            bare.insert(i);
            warnings.Add(PlaceIn(file, "/skins/" + std::to_string(i)),
                         "skin without joints is left out");
        });
        ForEachObject(root, "nodes", [&](json& node, size_t i) {
            const FileLoc loc = PlaceIn(file, "/nodes/" + std::to_string(i));
            const json* skin = Member(&node, "skin");
            if (skin && bare.contains(IndexOf(*skin).value_or(bare.size()))) node.erase("skin");
            json* copies = Extension(&node, "EXT_mesh_gpu_instancing");
            json* attributes = copies ? Member(copies, "attributes") : nullptr;
            if (!attributes) return;
            if (std::ranges::any_of(*attributes, [&](const json& a) { return IsEmpty(a); })) {
                warnings.Add(loc, "a mesh of no copies is left out");
                node.erase("mesh");
                attributes->clear();
            }
            if (attributes->empty()) node["extensions"].erase("EXT_mesh_gpu_instancing");
        });
        ForEachObject(root, "animations", [&](json& animation, size_t i) {
            const FileLoc loc = PlaceIn(file, "/animations/" + std::to_string(i));
            for (const char* name : {"channels", "samplers"})
                if (!animation.contains(name)) animation[name] = json::array();
            std::set<size_t> empty;
            ForEachObject(&animation, "samplers", [&](json& sampler, size_t s) {
                for (const char* name : {"input", "output"})
                    if (const json* keys = Member(&sampler, name); keys && IsEmpty(*keys))
                        empty.insert(s);
            });
            json& channels = animation["channels"];
            for (auto c = channels.begin(); c != channels.end();) {
                const json* sampler = Member(&*c, "sampler");
                if (!sampler ||
                    !empty.contains(IndexOf(*sampler).value_or(empty.size() + channels.size()))) {
                    ++c;
                    continue;
                }
                warnings.Add(loc, "animation without keys is left out");
                c = channels.erase(c);
            }
        });
    }
    // Nothing reads these any more.
    void FillAccessors() {
        ForEachObject(root, "accessors", [&](json& accessor, size_t i) {
            json* sparse = Member(&accessor, "sparse");
            if (sparse && IsZero(Member(sparse, "count"))) accessor.erase("sparse");
            if (!IsEmpty(i)) return;
            accessor.erase("bufferView");
            accessor.erase("sparse");
            accessor["count"] = 1u;
        });
    }
    // A spot has the angles of the specification, a light of no kind no light.
    void FillLights() {
        json* lights = Extension(root, "KHR_lights_punctual");
        if (!lights) return;
        ForEachObject(lights, "lights", [&](json& light, size_t i) {
            const FileLoc loc =
                PlaceIn(file, "/extensions/KHR_lights_punctual/lights/" + std::to_string(i));
            if (!light.contains("type")) {
                light = {{"type", "point"}, {"intensity", 0}};
                warnings.Add(loc, "light without a type is left out");
            } else if (light["type"] == "spot" && !light.contains("spot")) {
                light["spot"] = json::object();
                warnings.Add(loc, "spot light without angles has the usual ones");
            }
        });
    }
    // Those that nothing shows need no data.
    void FillImages() {
        std::set<size_t> shown;
        Collect(*root, "source", &shown);
        ForEachObject(root, "images", [&](json& image, size_t i) {
            if (!shown.contains(i) && !image.contains("uri") && !image.contains("bufferView"))
                image["uri"] = kOneByteUri;
        });
        ForEachObject(root, "samplers", [&](json& sampler, size_t) {
            for (const char* wrap : {"wrapS", "wrapT"})
                if (IsZero(Member(&sampler, wrap))) sampler.erase(wrap);
        });
    }
    // Nothing is clipped by these planes.
    void FillCameras() {
        ForEachObject(root, "cameras", [&](json& camera, size_t) {
            for (const char* type : {"perspective", "orthographic"})
                if (json* view = Member(&camera, type); view && view->is_object())
                    view->update({{"znear", 0.1}, {"zfar", 100}});
        });
    }
    void FillViews() {
        constexpr const char* kMeshopt = "EXT_meshopt_compression";
        std::set<size_t> views, buffers;
        Collect(*root, "bufferView", &views);
        ForEachObject(root, "bufferViews", [&](json& view, size_t i) {
            const json* compressed = Extension(&view, kMeshopt);
            if (views.contains(i)) Collect(compressed ? *compressed : view, "buffer", &buffers);
        });
        std::set<size_t> filled;
        ForEachObject(root, "buffers", [&](json& buffer, size_t i) {
            if (buffers.contains(i) && !IsZero(Member(&buffer, "byteLength"))) return;
            buffer = {{"uri", kOneByteUri}, {"byteLength", 1u}};
            filled.insert(i);
        });
        ForEachObject(root, "bufferViews", [&](json& view, size_t i) {
            const json* buffer = Member(&view, "buffer");
            const std::optional<size_t> of = buffer ? IndexOf(*buffer) : std::nullopt;
            const bool isOfFilled = of && filled.contains(*of) && !views.contains(i);
            if (!buffer || (!isOfFilled && !IsZero(Member(&view, "byteLength")))) return;
            view = {{"buffer", *buffer}, {"byteLength", 1u}};
        });
    }

    const std::string& file;
    json* root;
    Warnings& warnings;
};

}  // namespace

void RepairGltfJson(const std::string& file, json* root, Warnings& warnings) {
    Repair(file, root, warnings).Run();
}

}  // namespace lull
