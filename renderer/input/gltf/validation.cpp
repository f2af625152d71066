#include "renderer/input/gltf/validation.h"

#include <fmt/format.h>

#include <cstdint>

#include "renderer/input/gltf/json_at.h"

namespace lull {
namespace {

using nlohmann::json;

constexpr int kDeepest = 100;
constexpr double kLargest = 3.40282355e38;  // the largest float, as it is printed, is allowed
constexpr uint64_t kLargestSize = kLargestJsonSize;

void CheckUri(const JsonAt& owner) {
    owner.String("uri");
    if (!owner.Has("uri")) return;
    const auto uri = owner.value.at("uri").get<std::string>();
    if (!IsDataUri(uri)) return;
    const JsonAt at = owner.Member("uri");
    const std::optional<std::string> data = Base64Of(uri);
    if (!data) at.Fail("is a data URI that is not base64");
    for (size_t i = 0; i < data->size(); ++i) {
        const char c = (*data)[i];
        const bool isPadding = c == '=' && i + 2 >= data->size();
        if (!std::isalnum(static_cast<unsigned char>(c)) && c != '+' && c != '/' && !isPadding)
            at.Fail(fmt::format("is a data URI whose data are not base64 at character {}", i));
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
    const json& buffer = o.json.root.at("buffers").at(o.value.at("buffer").get<size_t>());
    const auto size = buffer.at("byteLength").get<uint64_t>();
    if (offset + length > size && !o.HasExtension("EXT_meshopt_compression"))
        o.Fail(fmt::format("ends at byte {} of a buffer of {}", offset + length, size));
    // Some write 0 for elements that follow each other.
    if (o.Whole("byteStride", 0, 252, 4) % 4 != 0)
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

size_t CountVariants(const json& root) {
    const json::json_pointer variants("/extensions/KHR_materials_variants/variants");
    return root.contains(variants) ? root.at(variants).size() : 0;
}

void CheckMapping(const JsonAt& mapping) {
    for (const char* name : {"material", "variants"}) mapping.Required(name);
    mapping.Index("material", "materials");
    const size_t count = CountVariants(mapping.json.root);
    mapping.ForEachAny("variants", [&](const JsonAt& v) {
        const std::optional<uint64_t> variant = v.WholeItself();
        if (!variant || *variant >= count)
            v.Fail(fmt::format("has to be the number of one of {} variants", count));
    });
}

void CheckPrimitive(const JsonAt& o) {
    o.Required("attributes");
    o.ForEachValue("attributes", [](const JsonAt& a) { a.IndexItself("accessors"); });
    o.Index("indices", "accessors");
    if (o.Has("indices")) {
        const auto indices = o.value.at("indices").get<size_t>();
        if (!o.json.root.at("accessors").at(indices).contains("bufferView"))
            o.Member("indices").Fail(
                "is an accessor without a \"bufferView\", which is not supported for indices");
    }
    o.ForEach("targets", [](const JsonAt& target) {
        for (const auto& [name, accessor] : target.value.items())
            JsonAt{target.json, accessor, target.path + "/" + Printable(name)}.IndexItself(
                "accessors");
    });
    o.Index("material", "materials");
    o.Whole("mode", 0, 6, 4);
    o.Extension("KHR_materials_variants", [](const JsonAt& e) {
        e.Required("mappings");
        e.ForEach("mappings", CheckMapping);
    });
    o.Extension("KHR_draco_mesh_compression", [](const JsonAt& draco) {
        draco.Required("bufferView");
        draco.Required("attributes");
        draco.Index("bufferView", "bufferViews");
        draco.ForEachValue("attributes", [](const JsonAt& id) {
            const std::optional<uint64_t> attribute = id.WholeItself();
            if (!attribute || *attribute > 1u << 30)
                id.Fail("has to be the identifier of an attribute");
        });
    });
}

void CheckWeights(const JsonAt& o) {
    o.ForEachAny("weights", [](const JsonAt& weight) {
        if (!weight.value.is_number()) weight.Fail("has to be a number");
    });
}

void CheckSkin(const JsonAt& o) {
    o.Required("joints");
    o.Indices("joints", "nodes");
    o.Index("inverseBindMatrices", "accessors");
}

void CheckAnimation(const JsonAt& o) {
    o.String("name");
    for (const char* name : {"channels", "samplers"}) o.Required(name);
    o.ForEach("samplers", [](const JsonAt& sampler) {
        for (const char* name : {"input", "output"}) {
            sampler.Required(name);
            sampler.Index(name, "accessors");
        }
        sampler.OneOf("interpolation", {"LINEAR", "STEP", "CUBICSPLINE"});
    });
    const uint64_t samplers = o.value.at("samplers").size();
    o.ForEach("channels", [&](const JsonAt& channel) {
        for (const char* name : {"sampler", "target"}) channel.Required(name);
        if (channel.Whole("sampler", 0, kLargestSize, 0) >= samplers)
            channel.Member("sampler").Fail(fmt::format("there are only {} samplers", samplers));
        const JsonAt target = channel.Member("target");
        target.Object();
        target.Required("path");
        target.String("path");
        target.Index("node", "nodes");
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
    CheckWeights(o);
    if (o.Has("matrix") && (o.Has("rotation") || o.Has("scale") || o.Has("translation")))
        o.Member("matrix").Fail("is combined with a rotation, scale or translation");
    o.Extension("EXT_mesh_gpu_instancing", [](const JsonAt& e) {
        e.Required("attributes");
        e.ForEachValue("attributes", [](const JsonAt& a) { a.IndexItself("accessors"); });
    });
    o.Extension("KHR_lights_punctual", [&](const JsonAt& e) {
        const json::json_pointer lights("/extensions/KHR_lights_punctual/lights");
        const size_t count = o.json.root.contains(lights) ? o.json.root.at(lights).size() : 0;
        e.Required("light");
        const uint64_t light = e.Whole("light", 0, kLargestSize, 0);
        if (light >= count)
            e.Member("light").Fail(
                fmt::format("is {}, but there are only {} lights", light, count));
    });
    o.Extension("KHR_node_visibility", [](const JsonAt& e) { e.Bool("visible"); });
    o.Extras({"hiddenFromCamera", "castsNoShadow"});
}

// Textures are named all over a material and its extensions, always by members called ...Texture.
void CheckTextureInfos(const JsonAt& o) {
    if (!o.value.is_object()) return;
    for (const auto& [name, value] : o.value.items()) {
        const JsonAt member{o.json, value, o.path + "/" + Printable(name)};
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
    o.NotBelowZero("emissiveFactor");
    o.OneOf("alphaMode", {"OPAQUE", "MASK", "BLEND"});
    o.Number("alphaCutoff");
    o.Bool("doubleSided");
    if (o.Has("pbrMetallicRoughness")) {
        const JsonAt pbr = o.Member("pbrMetallicRoughness");
        pbr.Object();
        pbr.Numbers("baseColorFactor", 4);
        pbr.Number("metallicFactor");
        pbr.Number("roughnessFactor");
        if (!o.HasExtension("KHR_materials_unlit"))  // which shines as brightly as it says
            for (const char* name : {"baseColorFactor", "metallicFactor", "roughnessFactor"})
                pbr.Clamped(name);
    }
    const auto clamped = [&](const char* extension, std::initializer_list<const char*> names) {
        o.Extension(extension, [&](const JsonAt& e) {
            for (const char* name : names) {
                e.Number(name);
                e.Clamped(name);
            }
        });
    };
    clamped("KHR_materials_clearcoat", {"clearcoatFactor", "clearcoatRoughnessFactor"});
    clamped("KHR_materials_transmission", {"transmissionFactor"});
    clamped("KHR_materials_specular", {"specularFactor"});
    o.Extension("KHR_materials_emissive_strength", [](const JsonAt& e) {
        e.Number("emissiveStrength");
        e.NotBelowZero("emissiveStrength");
    });
    o.Extension("KHR_materials_specular", [](const JsonAt& e) {
        e.Numbers("specularColorFactor", 3);
        e.NotBelowZero("specularColorFactor");
    });
    o.Extension("KHR_materials_ior", [](const JsonAt& e) { e.Number("ior"); });
    o.Extension("KHR_materials_volume", [](const JsonAt& e) {
        e.NumbersWithin("attenuationColor", 3, 0, 1);
        e.Number("thicknessFactor");
        if (e.Has("thicknessFactor") && !NotNegative(e.value.at("thicknessFactor")))
            e.Member("thicknessFactor").Fail("is negative");
        e.Number("attenuationDistance");
        if (e.Has("attenuationDistance") && !(e.value.at("attenuationDistance") > 0))
            e.Member("attenuationDistance").Fail("has to be above 0");
    });
    o.Extension("KHR_materials_sheen", [](const JsonAt& e) {
        e.NumbersWithin("sheenColorFactor", 3, 0, 1);
        e.NumberWithin("sheenRoughnessFactor", 0, 1);
    });
    o.Extension("KHR_materials_diffuse_transmission", [](const JsonAt& e) {
        e.NumberWithin("diffuseTransmissionFactor", 0, 1);
        e.NumbersWithin("diffuseTransmissionColorFactor", 3, 0, 1);
    });
    o.Extension("KHR_materials_anisotropy", [](const JsonAt& e) {
        e.NumberWithin("anisotropyStrength", 0, 1);
        e.Number("anisotropyRotation");
    });
    o.Extras({"addedInterface", "evenInterface", "keepsRadiance", "spread", "openBehind",
              "hiddenFromCamera", "castsNoShadow"});
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
    for (const char* name : {"yfov", "aspectRatio", "xmag", "ymag"}) view.Number(name);
    if (type == "perspective")
        view.Required("yfov");
    else
        for (const char* name : {"xmag", "ymag"}) view.Required(name);
    o.Extras({"shift", "lensRadius", "focusDistance", "clipStart", "clipEnd"},
             [](const JsonAt& lens) {
                 lens.Numbers("shift", 2);
                 lens.Number("lensRadius");
                 lens.Number("focusDistance");
                 lens.Number("clipStart");
                 lens.Number("clipEnd");
             });
}

void CheckImage(const JsonAt& o) {
    CheckUri(o);
    o.String("mimeType");
    o.Index("bufferView", "bufferViews");
    if (o.Has("uri") == o.Has("bufferView")) o.Fail("needs either a \"uri\" or a \"bufferView\"");
    if (!o.Has("bufferView")) return;
    const json& view = o.json.root.at("bufferViews").at(o.value.at("bufferView").get<size_t>());
    if (view.contains("extensions") && view.at("extensions").contains("EXT_meshopt_compression"))
        o.Member("bufferView").Fail("is compressed, as images cannot be");
}

// Numbers become floats everywhere. The depth of the value has been bounded.
void CheckNumbers(const JsonAt& o) {
    if (o.value.is_number() && !(std::abs(o.value.get<double>()) < kLargest))
        o.Fail("is too large a number");
    if (!o.value.is_structured()) return;
    for (const auto& [key, v] : o.value.items())
        if ((v.is_structured() || v.is_number()) && key != "extras")
            CheckNumbers({o.json, v, o.path + "/" + Printable(key)});
}

void CheckVersion(const JsonAt& root) {
    if (!root.value.contains("asset") || !root.value.at("asset").is_object() ||
        !root.value.at("asset").contains("version"))
        root.Fail("lacks \"asset\" with a \"version\": it is not a glTF file");
    const JsonAt asset = root.Member("asset");
    asset.String("version");
    asset.String("minVersion");
    const auto is2 = [](const std::string& version) { return version == "2" || version == "2.0"; };
    const auto version = asset.value.at("version").get<std::string>();
    if (!is2(version) && !version.starts_with("2."))
        root.Fail("is of glTF version " + Printable(version) + "; 2.0 is modelled");
    if (!asset.Has("minVersion")) return;
    // That of readers which can read the file.
    const auto least = asset.value.at("minVersion").get<std::string>();
    if (!is2(least))
        asset.Member("minVersion").Fail("is " + Printable(least) + "; 2.0 is modelled");
}

void CheckLights(const JsonAt& root) {
    root.Extension("KHR_lights_punctual", [](const JsonAt& e) {
        e.ForEach("lights", [](const JsonAt& light) {
            light.Required("type");
            light.OneOf("type", {"directional", "point", "spot"});
            light.Numbers("color", 3);
            light.NotBelowZero("color");
            light.Number("intensity");
            light.Number("range");
            light.Extras({"radius", "angle", "profile"}, [](const JsonAt& e) {
                for (const char* name : {"radius", "angle"}) e.Number(name);
                e.String("profile");
            });
            if (light.value.at("type") == "spot") {
                light.Required("spot");
                light.Member("spot").Object();
                light.Member("spot").Number("innerConeAngle");
                light.Member("spot").Number("outerConeAngle");
            }
        });
    });
}

void CheckVariants(const JsonAt& root) {
    root.Extension("KHR_materials_variants", [](const JsonAt& e) {
        e.Required("variants");
        e.ForEach("variants", [](const JsonAt& variant) {
            variant.Required("name");
            variant.String("name");
        });
    });
}

}  // namespace

json ParseGltfJson(const std::string& file, std::string_view text) {
    const auto checkDepth = [&](int depth, json::parse_event_t, json&) {
        if (depth > kDeepest) throw Error("{}: is nested more than {} levels deep", file, kDeepest);
        return true;
    };
    try {
        json root = json::parse(text, checkDepth);
        if (!root.is_object()) throw Error(file + ": is not a JSON object");
        return root;
    } catch (const json::exception& e) {
        throw Error("{}: is not valid JSON: {}", file, Printable(e.what(), 200));
    }
}

void CheckGltfJson(const std::string& file, json* json, Warnings& warnings) {
    JsonChecked checked{*json, file, warnings};
    const JsonAt root{checked, *json, ""};
    CheckVersion(root);
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
    CheckLights(root);
    CheckVariants(root);
    root.ForEach("buffers", CheckBuffer);
    root.ForEach("bufferViews", CheckBufferView);
    root.ForEach("accessors", CheckAccessor);
    root.ForEach("meshes", [](const JsonAt& o) {
        o.Required("primitives");
        o.ForEach("primitives", CheckPrimitive);
        CheckWeights(o);
    });
    root.ForEach("nodes", CheckNode);
    root.ForEach("skins", CheckSkin);
    root.ForEach("animations", CheckAnimation);
    root.ForEach("scenes", [](const JsonAt& o) { o.Indices("nodes", "nodes"); });
    root.Index("scene", "scenes");
    root.ForEach("materials", CheckMaterial);
    root.ForEach("cameras", CheckCamera);
    root.ForEach("images", CheckImage);
    root.ForEach("textures", [](const JsonAt& o) {
        o.Index("source", "images");
        o.Index("sampler", "samplers");
        o.Extension("EXT_texture_webp", [](const JsonAt& e) { e.Index("source", "images"); });
    });
    root.ForEach("samplers", [](const JsonAt& o) {
        o.OneOfNumbers("wrapS", {33071, 33648, 10497});
        o.OneOfNumbers("wrapT", {33071, 33648, 10497});
        for (const char* name : {"magFilter", "minFilter"}) o.Whole(name, 0, kLargestSize, 0);
    });
}

}  // namespace lull
