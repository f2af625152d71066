// Lets files be read that break the specification where that does no harm.
#include <optional>
#include <set>
#include <string>

#include "renderer/input/gltf/json_at.h"
#include "renderer/input/gltf/validation.h"

namespace lull {
namespace {

using nlohmann::json;

// Returns a member of an object; null where there is none.
json* Member(json* value, const char* name) {
    if (!value->is_object()) return nullptr;
    const auto found = value->find(name);
    return found == value->end() ? nullptr : &*found;
}

json* Extension(json* owner, const char* name) {
    json* extensions = Member(owner, "extensions");
    return extensions ? Member(extensions, name) : nullptr;
}

// Calls f(element, index) for the objects in an array that is a member.
template <typename F>
void ForEachObject(json* owner, const char* name, const F& f) {
    json* array = Member(owner, name);
    if (!array || !array->is_array()) return;
    for (size_t i = 0; i < array->size(); ++i)
        if (array->at(i).is_object()) f(array->at(i), i);
}

bool IsZero(const json* value) { return value && value->is_number() && value->get<double>() == 0; }

void EraseNulls(const std::string& file, const std::string& path, json* value, Warnings& warnings) {
    if (value->is_array())
        for (size_t i = 0; i < value->size(); ++i)
            EraseNulls(file, path + "/" + std::to_string(i), &value->at(i), warnings);
    if (!value->is_object()) return;
    for (auto it = value->begin(); it != value->end();) {
        if (it->is_null()) {
            warnings.Add(PlaceIn(file, path), "null counts as absent", Printable(it.key()));
            it = value->erase(it);
            continue;
        }
        if (it->is_structured() && it.key() != "extras")
            EraseNulls(file, path + "/" + Printable(it.key()), &*it, warnings);
        ++it;
    }
}

// Returns an index, which may be written as 4.0.
std::optional<size_t> IndexOf(const json& value) {
    if (!value.is_number()) return {};
    const auto n = value.get<double>();
    if (!(n >= 0 && n < 1e9)) return {};
    return size_t(n);
}

// Collects the numbers that members of this name have or hold, at any depth.
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
        EraseNulls(file, "", root, warnings);
        LeaveOutDistances();
        LeaveOutPrimitives();
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
                        ++p;
                        continue;
                    }
                    p = primitives->erase(p);
                    warnings.Add(loc, "primitive without vertices or indices is left out");
                }
            }
        });
    }
    // Those that are read stay as they are, and are refused.
    void FillAccessors() {
        std::set<size_t> read;
        for (const char* readers : {"meshes", "animations", "skins", "nodes"})
            if (const json* array = Member(root, readers))
                for (const char* name :
                     {"attributes", "indices", "input", "inverseBindMatrices", "output", "targets"})
                    Collect(*array, name, &read);
        ForEachObject(root, "accessors", [&](json& accessor, size_t i) {
            if (read.contains(i) || !IsEmpty(i)) return;
            accessor.erase("bufferView");
            accessor.erase("sparse");
            accessor["count"] = 1u;
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
