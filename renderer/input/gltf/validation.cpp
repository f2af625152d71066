#include "renderer/input/gltf/validation.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <set>

#include "renderer/base/error.h"
#include "renderer/files/file_contents.h"

namespace lull {
namespace {

using nlohmann::json;

constexpr int kDeepest = 100;
constexpr double kLargest = 3e38;
// Beyond this no file of ours or anybody's goes, and all sums of two are still exact.
constexpr uint64_t kLargestSize = uint64_t(1) << 48;

// Holds a value and where it stands.
struct JsonAt {
    const json& root;
    const std::string& file;
    const json& value;
    std::string path;

    [[noreturn]] void Fail(const std::string& problem) const {
        throw Error(fmt::format("{}: {}: {}", file, path.empty() ? "/" : path, problem));
    }
    JsonAt Member(const std::string& name) const {
        return {root, file, value.at(name), path + "/" + name};
    }
    bool Has(const std::string& name) const { return value.contains(name); }

    void Object() const {
        if (!value.is_object()) Fail("has to be an object");
    }
    void String(const std::string& name) const {
        if (Has(name) && !value.at(name).is_string()) Member(name).Fail("has to be a string");
    }
    void Bool(const std::string& name) const {
        if (Has(name) && !value.at(name).is_boolean()) Member(name).Fail("has to be true or false");
    }
    // Returns a whole number from `least` to `most`, `otherwise` where it is absent.
    uint64_t Whole(const std::string& name, uint64_t least, uint64_t most,
                   uint64_t otherwise) const {
        if (!Has(name)) return otherwise;
        const JsonAt member = Member(name);
        if (!member.value.is_number_unsigned())
            member.Fail("has to be a whole number, not negative");
        const auto n = member.value.get<uint64_t>();
        if (n < least || n > most)
            member.Fail(fmt::format("is {}, but has to lie between {} and {}", n, least, most));
        return n;
    }
    void Required(const std::string& name) const {
        if (!Has(name)) Fail("lacks \"" + name + "\"");
    }
    void Number(const std::string& name) const {
        if (Has(name) && !value.at(name).is_number()) Member(name).Fail("has to be a number");
    }
    void Numbers(const std::string& name, size_t count) const {
        if (!Has(name)) return;
        const JsonAt member = Member(name);
        if (!member.value.is_array() || member.value.size() != count)
            member.Fail(fmt::format("has to be an array of {} numbers", count));
        for (const json& n : member.value)
            if (!n.is_number()) member.Fail(fmt::format("has to be an array of {} numbers", count));
    }
    void OneOf(const std::string& name, std::initializer_list<const char*> names) const {
        String(name);
        if (!Has(name)) return;
        for (const char* n : names)
            if (value.at(name) == n) return;
        Member(name).Fail("is \"" + Printable(value.at(name).get<std::string>()) +
                          "\", which is not defined");
    }
    void OneOfNumbers(const std::string& name, std::initializer_list<uint64_t> numbers) const {
        if (!Has(name)) return;
        const uint64_t n = Whole(name, 0, kLargestSize, 0);
        for (const uint64_t one : numbers)
            if (n == one) return;
        Member(name).Fail(fmt::format("is {}, which is not defined", n));
    }

    // Checks an index into one of the top-level arrays.
    void IndexItself(const std::string& array) const {
        const size_t size = root.contains(array) ? root.at(array).size() : 0;
        if (!value.is_number_unsigned()) Fail("has to be an index, a whole number");
        if (value.get<uint64_t>() >= size)
            Fail(
                fmt::format("is {}, but there are only {} {}", value.get<uint64_t>(), size, array));
    }
    void Index(const std::string& name, const std::string& array) const {
        if (Has(name)) Member(name).IndexItself(array);
    }
    void Indices(const std::string& name, const std::string& array) const {
        ForEachAny(name, [&](const JsonAt& index) { index.IndexItself(array); });
    }

    template <typename F>
    void ForEachAny(const std::string& name, const F& f) const {
        if (!Has(name)) return;
        const JsonAt member = Member(name);
        if (!member.value.is_array()) member.Fail("has to be an array");
        for (size_t i = 0; i < member.value.size(); ++i)
            f(JsonAt{root, file, member.value[i], fmt::format("{}/{}", member.path, i)});
    }
    template <typename F>
    void ForEach(const std::string& name, const F& f) const {
        ForEachAny(name, [&](const JsonAt& one) {
            one.Object();
            f(one);
        });
    }
    // Calls f with the values of an object.
    template <typename F>
    void ForEachValue(const std::string& name, const F& f) const {
        if (!Has(name)) return;
        const JsonAt member = Member(name);
        member.Object();
        for (const auto& [key, v] : member.value.items())
            f(JsonAt{root, file, v, member.path + "/" + Printable(key)});
    }
    // Calls f with an extension that the object has.
    template <typename F>
    void Extension(const std::string& name, const F& f) const {
        if (!Has("extensions")) return;
        const JsonAt extensions = Member("extensions");
        extensions.Object();
        if (!extensions.Has(name)) return;
        const JsonAt extension = extensions.Member(name);
        extension.Object();
        f(extension);
    }
    // Calls f with what the object has for lull alone.
    template <typename F>
    void Extras(const F& f) const {
        if (!Has("extras") || !value.at("extras").contains("lull")) return;
        const JsonAt extras = Member("extras").Member("lull");
        extras.Object();
        f(extras);
    }
};

void CheckUri(const JsonAt& owner) {
    owner.String("uri");
    if (!owner.Has("uri")) return;
    const auto uri = owner.value.at("uri").get<std::string>();
    if (!uri.starts_with("data:")) return;
    const JsonAt at = owner.Member("uri");
    const size_t comma = uri.find(',');
    if (comma == std::string::npos || !uri.substr(0, comma).ends_with(";base64"))
        at.Fail("is a data URI that is not base64");
    for (size_t i = comma + 1; i < uri.size(); ++i) {
        const char c = uri[i];
        const bool isPadding = c == '=' && i + 2 >= uri.size();
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '+' && c != '/' && !isPadding)
            at.Fail(fmt::format("is a data URI whose character {} is not base64", i));
    }
}

void CheckBuffer(const JsonAt& o) {
    o.Required("byteLength");
    o.Whole("byteLength", 1, kLargestSize, 1);
    CheckUri(o);
}

void CheckBufferView(const JsonAt& o) {
    o.Required("buffer");
    o.Required("byteLength");
    o.Index("buffer", "buffers");
    const uint64_t offset = o.Whole("byteOffset", 0, kLargestSize, 0);
    const uint64_t length = o.Whole("byteLength", 1, kLargestSize, 1);
    const json& buffer = o.root.at("buffers").at(o.value.at("buffer").get<size_t>());
    const auto size = buffer.at("byteLength").get<uint64_t>();
    if (offset + length > size)
        o.Fail(fmt::format("ends at byte {} of a buffer of {}", offset + length, size));
    if (o.Whole("byteStride", 4, 252, 4) % 4 != 0)
        o.Member("byteStride").Fail("has to be a multiple of 4");
    o.Extension("EXT_meshopt_compression", [](const JsonAt& e) {
        for (const char* name : {"buffer", "byteLength", "byteStride", "count", "mode"})
            e.Required(name);
        e.Index("buffer", "buffers");
        e.Whole("byteOffset", 0, kLargestSize, 0);
        e.Whole("byteLength", 1, kLargestSize, 1);
        e.Whole("byteStride", 2, 256, 4);
        e.Whole("count", 1, uint64_t(1) << 31, 1);
        e.OneOf("mode", {"ATTRIBUTES", "TRIANGLES", "INDICES"});
        e.OneOf("filter", {"NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL"});
    });
}

void CheckAccessor(const JsonAt& o) {
    for (const char* name : {"componentType", "count", "type"}) o.Required(name);
    o.Index("bufferView", "bufferViews");
    o.Whole("byteOffset", 0, kLargestSize, 0);
    o.OneOfNumbers("componentType", {5120, 5121, 5122, 5123, 5125, 5126});
    o.Whole("count", 1, kLargestSize, 1);
    o.OneOf("type", {"SCALAR", "VEC2", "VEC3", "VEC4", "MAT2", "MAT3", "MAT4"});
    o.Bool("normalized");
    if (!o.Has("sparse")) return;
    const JsonAt sparse = o.Member("sparse");
    sparse.Object();
    constexpr uint64_t kMost = (uint64_t(1) << 31) - 1;
    for (const char* name : {"count", "indices", "values"}) sparse.Required(name);
    sparse.Whole("count", 1, kMost, 1);
    for (const char* name : {"indices", "values"}) {
        const JsonAt part = sparse.Member(name);
        part.Object();
        part.Required("bufferView");
        part.Index("bufferView", "bufferViews");
        part.Whole("byteOffset", 0, kMost, 0);
    }
    sparse.Member("indices").Required("componentType");
    sparse.Member("indices").OneOfNumbers("componentType", {5121, 5123, 5125});
}

void CheckPrimitive(const JsonAt& o) {
    o.Required("attributes");
    o.ForEachValue("attributes", [](const JsonAt& a) { a.IndexItself("accessors"); });
    o.Index("indices", "accessors");
    o.Index("material", "materials");
    o.Whole("mode", 0, 6, 4);
    o.Extension("KHR_draco_mesh_compression", [](const JsonAt& draco) {
        draco.Required("bufferView");
        draco.Required("attributes");
        draco.Index("bufferView", "bufferViews");
        draco.ForEachValue("attributes", [](const JsonAt& id) {
            if (!id.value.is_number_unsigned() || id.value.get<uint64_t>() > 1u << 30)
                id.Fail("has to be the identifier of an attribute");
        });
    });
}

void CheckNode(const JsonAt& o) {
    o.String("name");
    o.Index("camera", "cameras");
    o.Index("mesh", "meshes");
    o.Index("skin", "skins");
    o.Indices("children", "nodes");
    o.Numbers("matrix", 16);
    o.Numbers("rotation", 4);
    o.Numbers("scale", 3);
    o.Numbers("translation", 3);
    if (o.Has("matrix") && (o.Has("rotation") || o.Has("scale") || o.Has("translation")))
        o.Member("matrix").Fail("stands beside a rotation, scale or translation");
    o.Extension("EXT_mesh_gpu_instancing", [](const JsonAt& e) {
        e.Required("attributes");
        e.ForEachValue("attributes", [](const JsonAt& a) { a.IndexItself("accessors"); });
    });
    o.Extension("KHR_lights_punctual", [&](const JsonAt& e) {
        const json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
        const size_t count = o.root.contains(lights) ? o.root.at(lights).size() : 0;
        e.Required("light");
        e.Whole("light", 0, kLargestSize, 0);
        if (e.value.at("light").get<uint64_t>() >= count)
            e.Member("light").Fail(fmt::format("is {}, but there are only {} lights",
                                               e.value.at("light").get<uint64_t>(), count));
    });
}

// Textures are named all over a material and its extensions, always by members called ...Texture.
void CheckTextureInfos(const JsonAt& o) {
    if (!o.value.is_object()) return;
    for (const auto& [name, value] : o.value.items()) {
        const JsonAt member{o.root, o.file, value, o.path + "/" + Printable(name)};
        if (name == "extras") continue;
        if (name.ends_with("Texture")) {
            member.Object();
            member.Required("index");
            member.Index("index", "textures");
            member.Whole("texCoord", 0, 1000, 0);
            member.Number("scale");
            member.Extension("KHR_texture_transform", [](const JsonAt& t) {
                t.Numbers("offset", 2);
                t.Numbers("scale", 2);
                t.Number("rotation");
                t.Whole("texCoord", 0, 1000, 0);
            });
        } else {
            CheckTextureInfos(member);
        }
    }
}

void CheckMaterial(const JsonAt& o) {
    o.String("name");
    o.Numbers("emissiveFactor", 3);
    o.OneOf("alphaMode", {"OPAQUE", "MASK", "BLEND"});
    o.Number("alphaCutoff");
    o.Bool("doubleSided");
    if (o.Has("pbrMetallicRoughness")) {
        const JsonAt pbr = o.Member("pbrMetallicRoughness");
        pbr.Object();
        pbr.Numbers("baseColorFactor", 4);
        pbr.Number("metallicFactor");
        pbr.Number("roughnessFactor");
    }
    o.Extension("KHR_materials_specular",
                [](const JsonAt& e) { e.Numbers("specularColorFactor", 3); });
    o.Extension("KHR_materials_volume", [](const JsonAt& e) { e.Numbers("attenuationColor", 3); });
    CheckTextureInfos(o);
}

void CheckCamera(const JsonAt& o) {
    o.String("name");
    o.Required("type");
    o.OneOf("type", {"perspective", "orthographic"});
    const auto type = o.value.at("type").get<std::string>();
    o.Required(type);
    const JsonAt view = o.Member(type);
    view.Object();
    for (const char* name : {"yfov", "aspectRatio", "znear", "zfar", "xmag", "ymag"})
        view.Number(name);
    for (const char* name : {"yfov", "xmag", "ymag"})
        if ((name[0] == 'y' && name[1] == 'f') == (type == "perspective")) view.Required(name);
    o.Extras([](const JsonAt& lens) {
        lens.Numbers("shift", 2);
        lens.Number("lensRadius");
        lens.Number("focusDistance");
    });
}

void CheckImage(const JsonAt& o) {
    CheckUri(o);
    o.String("mimeType");
    o.Index("bufferView", "bufferViews");
    if (o.Has("uri") == o.Has("bufferView")) o.Fail("needs either a \"uri\" or a \"bufferView\"");
    if (o.Has("bufferView")) o.Required("mimeType");
}

// Numbers become floats everywhere. The depth of the value has been bounded.
void CheckNumbers(const JsonAt& o) {
    if (o.value.is_number() && !(std::abs(o.value.get<double>()) < kLargest))
        o.Fail("is too large a number");
    if (!o.value.is_structured()) return;
    for (const auto& [key, v] : o.value.items())
        if (v.is_structured() || v.is_number())
            CheckNumbers({o.root, o.file, v, o.path + "/" + Printable(key)});
}

}  // namespace

json ParseGltfJson(const std::string& file, std::string_view text) {
    const auto checkDepth = [&](int depth, json::parse_event_t, json&) {
        if (depth > kDeepest)
            throw Error(fmt::format("{}: is nested more than {} levels deep", file, kDeepest));
        return true;
    };
    try {
        json root = json::parse(text, checkDepth);
        if (!root.is_object()) throw Error(file + ": is no JSON object");
        return root;
    } catch (const json::exception& e) {
        throw Error(fmt::format("{}: is no valid JSON: {}", file, Printable(e.what())));
    }
}

void CheckGltfJson(const std::string& file, const json& json) {
    const JsonAt root{json, file, json, ""};
    if (!json.contains("asset") || !json.at("asset").is_object() ||
        !json.at("asset").contains("version") || !json.at("asset").at("version").is_string())
        root.Fail("lacks \"asset\" with a \"version\": it is no glTF file");
    const std::string version = json.at("asset").at("version");
    if (!version.starts_with("2."))
        root.Fail("is of glTF version " + Printable(version) + "; 2.0 is modelled");
    CheckNumbers(root);
    // Names of arrays are looked up everywhere below, so that they come first.
    for (const char* name :
         {"accessors", "animations", "buffers", "bufferViews", "cameras", "images", "materials",
          "meshes", "nodes", "samplers", "scenes", "skins", "textures"})
        root.ForEach(name, [](const JsonAt&) {});
    for (const char* name : {"extensionsUsed", "extensionsRequired"})
        root.ForEachAny(name, [](const JsonAt& e) {
            if (!e.value.is_string()) e.Fail("has to be a string");
        });
    root.Extension("KHR_lights_punctual", [](const JsonAt& e) {
        e.ForEach("lights", [](const JsonAt& light) {
            light.Required("type");
            light.OneOf("type", {"directional", "point", "spot"});
            light.Numbers("color", 3);
            light.Number("intensity");
            light.Number("range");
            light.Extras([](const JsonAt& e) { e.Number("radius"); });
            if (light.value.at("type") == "spot" && light.Has("spot")) {
                light.Member("spot").Object();
                light.Member("spot").Number("innerConeAngle");
                light.Member("spot").Number("outerConeAngle");
            }
        });
    });
    root.ForEach("buffers", CheckBuffer);
    root.ForEach("bufferViews", CheckBufferView);
    root.ForEach("accessors", CheckAccessor);
    root.ForEach("meshes", [](const JsonAt& o) {
        o.Required("primitives");
        o.ForEach("primitives", CheckPrimitive);
    });
    root.ForEach("nodes", CheckNode);
    root.ForEach("scenes", [](const JsonAt& o) { o.Indices("nodes", "nodes"); });
    root.Index("scene", "scenes");
    root.ForEach("materials", CheckMaterial);
    root.ForEach("cameras", CheckCamera);
    root.ForEach("images", CheckImage);
    root.ForEach("textures", [](const JsonAt& o) {
        o.Index("source", "images");
        o.Index("sampler", "samplers");
    });
    root.ForEach("samplers", [](const JsonAt& o) {
        o.OneOfNumbers("wrapS", {33071, 33648, 10497});
        o.OneOfNumbers("wrapT", {33071, 33648, 10497});
    });
}

}  // namespace lull
