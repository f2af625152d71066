// Checks that broken and hostile glTF files give one clear error, with the place.
#include <algorithm>
#include <cmath>

#include "tests/renderer/input/gltf_files.h"

namespace lull {
namespace {

// Returns a file with a mesh, a texture and a camera that has nothing wrong with it.
GltfFile GoodFile() {
    GltfFile file;
    const int p = file.Floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
    const int uv = file.Floats({0, 0, 1, 0, 0, 1}, "VEC2");
    file.root["images"] = {{{"uri", "colors.png"}}};
    file.root["samplers"] = {{{"wrapS", 33071}}};
    file.root["textures"] = {{{"source", 0}, {"sampler", 0}}};
    file.root["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    file.Node({{"mesh", file.Mesh({{"POSITION", p}, {"TEXCOORD_0", uv}},
                                  {{"indices", file.Indices({0, 1, 2})}, {"material", 0}})}});
    file.root["cameras"] = json::array({kPerspectiveCamera});
    file.Node({{"camera", 0}});
    return file;
}

struct Case {
    const char* pointer;
    json value;
    const char* message;
};

TEST(GltfErrors, NameTheirPlace) {
    ASSERT_EQ(kFolder.ErrorOf(GoodFile()), "");
    const Case cases[] = {
        {"/asset/version", "1.0", "/: is of glTF version 1.0; 2.0 is modelled"},
        {"/asset/version", 2.0, "/asset/version: has to be a string"},
        {"/asset/minVersion", "2.1", "/asset/minVersion: is 2.1; 2.0 is modelled"},
        {"/scene", 1, "/scene: is 1, but there are only 1 scenes"},
        {"/scenes/0/nodes/0", 7, "/scenes/0/nodes/0: is 7, but there are only 2 nodes"},
        {"/nodes/0/mesh", -2, "/nodes/0/mesh: has to be an index, a whole number"},
        {"/nodes/0/mesh", 1.5, "/nodes/0/mesh: has to be an index, a whole number"},
        {"/nodes/0/children", {1, 1}, "/nodes/1: has two parents, or is its own ancestor"},
        {"/nodes/0/children", json::array({0}),
         "/nodes/0: has two parents, or is its own ancestor"},
        {"/nodes/0/matrix", {1, 2}, "/nodes/0/matrix: has to be an array of 16 numbers"},
        {"/nodes/0/scale", {1e300, 1, 1}, "/nodes/0/scale/0: is too large a number"},
        {"/nodes/0/scale", {"x", 1, 1}, "/nodes/0/scale: has to be an array of 3 numbers"},
        {"/meshes/0/primitives/0/attributes/POSITION", 9,
         "/meshes/0/primitives/0/attributes/POSITION: is 9, but there are only 3 accessors"},
        {"/meshes/0/primitives/0/attributes/POSITION", 1,
         "/accessors/1: has to have 3 components for its use"},
        {"/meshes/0/primitives/0/mode", 7,
         "/meshes/0/primitives/0/mode: is 7, but has to lie between 0 and 6"},
        {"/meshes/0/primitives/0/material", 4,
         "/meshes/0/primitives/0/material: is 4, but there are only 1 materials"},
        {"/accessors/0/count", 4,
         "/accessors/0: its 4 elements go beyond the 36 bytes of /bufferViews/0"},
        {"/accessors/0/count", 4294967295u,
         "/accessors/0: its 4294967295 elements go beyond the 36 bytes of /bufferViews/0"},
        {"/accessors/0/componentType", 5124,
         "/accessors/0/componentType: is 5124, which is not defined"},
        {"/accessors/0/type", "VEC5", "/accessors/0/type: is \"VEC5\", which is not defined"},
        {"/accessors/0/byteOffset", 30,
         "/accessors/0: its 3 elements go beyond the 36 bytes of /bufferViews/0"},
        {"/accessors/2",
         {{"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}},
         "/meshes/0/primitives/0/indices: is an accessor without a \"bufferView\", which is not "
         "supported for indices"},
        {"/accessors/2/componentType", 5126,
         "/accessors/2: has to hold unsigned integers, as indices do"},
        {"/accessors/1/count", 2, "/meshes/0/primitives/0: has 2 TEXCOORD_0 for 3 vertices"},
        {"/bufferViews/0/byteLength", 4000, "/bufferViews/0: ends at byte 4000 of a buffer of 66"},
        {"/bufferViews/0/byteStride", 6, "/bufferViews/0/byteStride: has to be a multiple of 4"},
        {"/bufferViews/0/byteStride", 8,
         "/accessors/0: its elements of 12 bytes overlap: the byteStride of /bufferViews/0 is 8"},
        {"/bufferViews/0/buffer", 1, "/bufferViews/0/buffer: is 1, but there are only 1 buffers"},
        {"/materials/0/alphaMode", "MAYBE",
         "/materials/0/alphaMode: is \"MAYBE\", which is not defined"},
        {"/materials/0/pbrMetallicRoughness/baseColorTexture/index", 3,
         "/materials/0/pbrMetallicRoughness/baseColorTexture/index: is 3, but there are only 1 "
         "textures"},
        {"/materials/0/pbrMetallicRoughness/baseColorTexture/texCoord", 5,
         "/materials/0/pbrMetallicRoughness/baseColorTexture: uses TEXCOORD_5; only 0 and 1 are "
         "modelled"},
        {"/textures/0/source", 2, "/textures/0/source: is 2, but there are only 1 images"},
        {"/samplers/0/wrapT", 3, "/samplers/0/wrapT: is 3, which is not defined"},
        {"/images/0/bufferView", 0, "/images/0: needs either a \"uri\" or a \"bufferView\""},
        {"/cameras/0/perspective/yfov", 4, "/cameras/0: yfov is 4; it has to lie between 0 and pi"},
        {"/cameras/0/type", "fisheye", "/cameras/0/type: is \"fisheye\", which is not defined"},
        {"/extensionsRequired",
         {"EXT_no_such_thing"},
         "/extensionsRequired/0: extension \"EXT_no_such_thing\" is required, but not supported"},
    };
    for (const Case& c : cases) {
        GltfFile file = GoodFile();
        file.root[json::json_pointer(c.pointer)] = c.value;
        if (std::string(c.pointer).starts_with("/bufferViews/0/byteLength")) file.bytes.resize(66);
        EXPECT_EQ(kFolder.ErrorOf(file), std::string("scene.gltf: ") + c.message) << c.pointer;
    }
}

TEST(GltfErrors, CheckTheRangesOfExtensions) {
    const std::string material = "/materials/0/extensions/";
    const std::string primitive = "/meshes/0/primitives/0/extensions/KHR_materials_variants";
    struct RangeCase {
        std::string pointer;
        json value;
        std::string message;
    };
    const std::string between = ", but has to lie between 0 and 1";
    const RangeCase cases[] = {
        {material + "KHR_materials_volume/attenuationDistance", -1, ": has to be above 0"},
        {material + "KHR_materials_volume/attenuationDistance", "far", ": has to be a number"},
        {material + "KHR_materials_volume/attenuationDistance", 1e300, ": is too large a number"},
        {material + "KHR_materials_volume/attenuationColor",
         {0.5, 0.5},
         ": has to be an array of 3 numbers"},
        {material + "KHR_materials_volume/attenuationColor", {0.5, 1.5, 0}, "/1: is 1.5" + between},
        {material + "KHR_materials_volume/thicknessFactor", -0.5, ": is negative"},
        {material + "KHR_materials_sheen/sheenColorFactor", {0, 0, -1}, "/2: is -1" + between},
        {material + "KHR_materials_sheen/sheenRoughnessFactor", 2, ": is 2" + between},
        {material + "KHR_materials_anisotropy/anisotropyStrength", 7, ": is 7" + between},
        {material + "KHR_materials_anisotropy/anisotropyRotation", true, ": has to be a number"},
        {"/extensions/KHR_materials_variants/variants",
         {{{"name", 3}}},
         "/0/name: has to be a string"},
        {material + "KHR_materials_unlit", true, ": has to be an object"},
        {"/extensions/KHR_materials_variants/variants", json::array({json::object()}),
         "/0: lacks \"name\""},
        {"/extensions/KHR_materials_variants/variants", 5, ": has to be an array"},
        {primitive + "/mappings", json::array({{{"material", 0}, {"variants", {0}}}}),
         "/0/variants/0: has to be the number of one of 0 variants"},
        {primitive + "/mappings", json::array({{{"material", 4}, {"variants", json::array()}}}),
         "/0/material: is 4, but there are only 1 materials"},
        {primitive + "/mappings", json::array({{{"material", 0}}}), "/0: lacks \"variants\""},
    };
    for (const RangeCase& c : cases) {
        GltfFile file = GoodFile();
        file.root[json::json_pointer(c.pointer)] = c.value;
        EXPECT_EQ(kFolder.ErrorOf(file), "scene.gltf: " + c.pointer + c.message);
    }
}

TEST(GltfErrors, FindWhatIsInTheBuffers) {
    GltfFile file = GoodFile();
    const float nan = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(&file.bytes[12], &nan, 4);
    EXPECT_EQ(kFolder.ErrorOf(file), "scene.gltf: /meshes/0/primitives/0: vertex 1 is not finite");
    file = GoodFile();
    file.bytes[60] = 9;
    EXPECT_EQ(kFolder.ErrorOf(file),
              "scene.gltf: /accessors/2: index 9 is out of range: there are 3 vertices");
}

// As in PLY files: what no triangle uses may be any number, and only positions have to be finite.
TEST(GltfErrors, AreOnlyWhatIsNotFiniteAndUsed) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    const auto quad = [&](const std::string& name, const char* type, int at, float weight) {
        GltfFile file;
        std::vector<float> p = {0, 0, 0, 1, 0, 0, 0, 1, 0, 5, 5, 5},
                           values(name == "POSITION" ? p : std::vector<float>(16, 0.5f));
        values.resize(4 * size_t(type[3] - '0'));
        values[size_t(at * (type[3] - '0'))] = kNan;
        const int broken = file.Floats(values, type);
        json attributes = {{"POSITION", name == "POSITION" ? broken : file.Floats(p, "VEC3")},
                           {"NORMAL", file.Floats(std::vector<float>(12, 1), "VEC3")}};
        if (weight == 0) attributes[name] = broken;
        if (name.starts_with("WEIGHTS"))
            attributes["JOINTS_0"] = file.Accessor(file.View(std::string(16, 0)), 5121, 4, "VEC4");
        json more = {{"indices", file.Indices({2, 0, 1})}};
        if (weight > 0) more["targets"] = {{{name, broken}}};
        json node = {{"mesh", file.Mesh(attributes, more)}};
        if (weight > 0) node["weights"] = {weight};
        if (name.starts_with("WEIGHTS")) node["skin"] = 0;
        file.Node(node);
        if (name.starts_with("WEIGHTS")) file.root["skins"] = {{{"joints", {0}}}};
        return file;
    };
    const std::pair<const char*, const char*> attributes[] = {
        {"POSITION", "VEC3"},   {"NORMAL", "VEC3"},  {"TANGENT", "VEC4"}, {"TEXCOORD_0", "VEC2"},
        {"TEXCOORD_1", "VEC2"}, {"COLOR_0", "VEC3"}, {"COLOR_0", "VEC4"}, {"WEIGHTS_0", "VEC4"}};
    for (const auto& [name, type] : attributes)
        for (const float weight : {0.f, 0.5f}) {
            const std::string kind = name;
            if (weight > 0 && kind != "POSITION" && kind != "NORMAL") continue;
            EXPECT_EQ(kFolder.ErrorOf(quad(name, type, 3, weight)), "") << name;
            Warnings warnings;
            const GltfFile used = quad(name, type, 1, weight);
            const std::string error = kFolder.ErrorOf(used);
            if (kind == "POSITION") {
                EXPECT_EQ(error, "scene.gltf: /meshes/0/primitives/0: vertex 1 is not finite");
            } else if (kind == "WEIGHTS_0") {
                EXPECT_EQ(error,
                          "scene.gltf: /meshes/0/primitives/0: vertex 1 has joints or weights that "
                          "are not finite");
            } else {
                const Description parsed = kFolder.Parse(used, {}, &warnings);
                for (const Parameter& parameter : parsed.shapes.at(0).parameters.All())
                    if (const auto* values = std::get_if<std::vector<float>>(&parameter.values)) {
                        EXPECT_TRUE(
                            std::ranges::all_of(*values, [](float v) { return std::isfinite(v); }))
                            << name << " " << parameter.name;
                    }
                EXPECT_EQ(warnings.Counts().at("value of a vertex that is not finite counts as 0"),
                          1)
                    << name;
            }
        }
}

TEST(GltfErrors, RefuseBadUris) {
    const auto errorOf = [&](const char* uri, int length) {
        GltfFile file = GoodFile();
        json whole = json::parse(file.Text());
        whole["buffers"][0]["uri"] = uri;
        whole["buffers"][0]["byteLength"] = length;
        return kFolder.ErrorOf(whole.dump());
    };
    EXPECT_EQ(errorOf("data:application/octet-stream;base64,AA*A", 66),
              "scene.gltf: /buffers/0/uri: is a data URI whose data are not base64 at character 2");
    EXPECT_EQ(errorOf("data:application/octet-stream,AAAA", 66),
              "scene.gltf: /buffers/0/uri: is a data URI that is not base64");
    EXPECT_EQ(errorOf("data:application/octet-stream;base64,AAAA", 66),
              "scene.gltf: /buffers/0: has 3 of its 66 bytes");
    EXPECT_NE(errorOf("no-such-file.bin", 66), "");
    EXPECT_NE(errorOf("/etc", 66), "");
}

TEST(GltfErrors, ReadDataUrisOfAnyType) {
    json whole = json::parse(GoodFile().Text());
    json& uri = whole["buffers"][0]["uri"];
    const std::string good = uri, data = good.substr(good.find(',') + 1);
    std::string encoded, lines;
    for (const char c : data) {
        encoded += c == '=' ? "%3D" : c == '+' ? "%2b" : std::string(1, c);
        lines += std::string(1, c) + (lines.size() % 10 == 0 ? "\r\n" : "");
    }
    for (const std::string& other :
         {"data:;base64," + data, "DATA:Application/X-Bin;charset=utf-8;BASE64," + data,
          "data:application/octet-stream;base64," + encoded,
          "data:application/octet-stream;base64," + lines}) {
        uri = other;
        EXPECT_EQ(kFolder.ErrorOf(whole.dump()), "") << other;
    }
}

TEST(GltfErrors, RefuseWhatIsNoGltf) {
    EXPECT_NE(kFolder.ErrorOf("{"), "");
    EXPECT_EQ(kFolder.ErrorOf("[1]"), "scene.gltf: is not a JSON object");
    EXPECT_EQ(kFolder.ErrorOf("{}"),
              "scene.gltf: /: lacks \"asset\" with a \"version\": it is not a glTF file");
    EXPECT_EQ(kFolder.ErrorOf(std::string(500, '[')),
              "scene.gltf: is nested more than 100 levels deep");
    EXPECT_NE(kFolder.ErrorOf(""), "");
}

TEST(GltfErrors, RefuseBrokenBinaries) {
    const std::string good = GoodFile().Binary();
    EXPECT_EQ(kFolder.ErrorOf(good, "scene.glb"), "");
    // Cut off anywhere, a file is an error and never a crash.
    for (size_t size = 0; size < good.size(); size += 7)
        EXPECT_NE(kFolder.ErrorOf(good.substr(0, size), "scene.glb"), "") << size;
    std::string bad = good;
    bad[4] = 1;
    EXPECT_EQ(kFolder.ErrorOf(bad, "scene.glb"), "scene.glb: is of GLB version 1; 2 is modelled");
    bad = good;
    bad[15] = '\x7f';
    EXPECT_HAS(kFolder.ErrorOf(bad, "scene.glb"), "goes beyond its end");
}

// Whatever bytes change, there is a scene or an Error.
TEST(GltfErrors, WithstandChangedBytes) {
    uint32_t state = 1;
    const auto below = [&](size_t n) {
        state = state * 1664525u + 1013904223u;
        return size_t(state >> 8) % n;
    };
    int errors = 0;
    for (const std::string& good : {GoodFile().Text(), GoodFile().Binary()})
        for (int i = 0; i < 1500; ++i) {
            std::string bad = good;
            for (size_t k = 1 + below(3); k > 0; --k) bad[below(bad.size())] = char(below(256));
            // Digits for digits, where the structure is to stay.
            if (i % 2)
                for (size_t k = 0; k < 3; ++k)
                    if (char& c = bad[below(bad.size())]; c >= '0' && c <= '9')
                        c = char('0' + below(10));
            errors += !kFolder.ErrorOf(bad).empty();
        }
    EXPECT_GT(errors, 1000);
}

}  // namespace
}  // namespace lull
