// Files that break the specification where it does no harm.
#include <fmt/format.h>

#include "tests/renderer/input/gltf_files.h"

namespace lull {
namespace {

// Returns a file with two triangles, each a mesh of its own.
GltfFile TwoTriangles() {
    GltfFile file = OneTriangle();
    file.Node({{"mesh", file.Triangle()}});
    return file;
}

// Returns the warnings of a file that has to have `shapes` shapes.
std::map<std::string, int> WarningsOf(const GltfFile& file, size_t shapes) {
    Warnings warnings;
    EXPECT_EQ(kFolder.Parse(file, {}, &warnings).shapes.size(), shapes);
    return warnings.Counts();
}

TEST(GltfRepair, TakesNullForAbsent) {
    GltfFile file = TwoTriangles();
    file.root["animations"] = nullptr;
    file.root["nodes"][0].update({{"children", nullptr},
                                  {"skin", nullptr},
                                  {"extensions", nullptr},
                                  {"extras", {{"any", nullptr}}}});
    file.root["materials"] = {
        {{"alphaMode", nullptr},
         {"extensions", {{"KHR_materials_volume", {{"attenuationDistance", nullptr}}}}}}};
    EXPECT_EQ(WarningsOf(file, 2).at("null counts as absent"), 6);
}

// Also where other parts of the file use it: what is left is what nobody wrote.
TEST(GltfRepair, TakesNothingsForAbsent) {
    GltfFile base = TwoTriangles();
    const int empty = base.Accessor(0, 5126, 3, "VEC3");
    base.root["accessors"][size_t(empty)]["count"] = 0;
    const auto warningsOf = [&](const std::string& patch, size_t shapes = 2) {
        GltfFile file = base;
        const json change = json::parse(fmt::format(fmt::runtime(patch), fmt::arg("empty", empty)));
        for (size_t i = 0; i < change.size(); i += 2)
            file.root[json::json_pointer(change[i].get<std::string>())] = change[i + 1];
        return WarningsOf(file, shapes);
    };
    const auto expect = [&](const std::string& patch, const std::string& warning,
                            size_t shapes = 2) {
        EXPECT_EQ(warningsOf(patch, shapes).count(warning), 1u) << patch;
    };
    const std::string nothing = "primitive without vertices or indices is left out";
    expect(R"(["/accessors/1/count", 0])", nothing, 1);
    expect(R"(["/bufferViews/1/byteLength", 0])", nothing, 1);
    expect(R"(["/accessors/3", {{"componentType": 5123, "count": 0, "type": "SCALAR"}},
               "/meshes/1/primitives/0/indices", 3])",
           nothing, 1);
    expect(R"(["/meshes/1", {{}}])", "mesh without primitives is left out", 1);
    // As three.js wrote infinity.
    expect(R"(["/materials", [{{"extensions": {{"KHR_materials_volume":
             {{"attenuationDistance": 0, "attenuationColor": [0.5, 0.5, 0.5]}}}}}}],
               "/meshes/0/primitives/0/material", 0])",
           "an attenuationDistance of 0 counts as absent");
    expect(R"(["/nodes/0/translation", [null, 1, 0]])", "null among numbers counts as absent");
    expect(R"(["/nodes/0/skin", -1])", "-1 counts as absent");
    expect(R"(["/nodes/0/extensions", []])", "[] counts as absent");
    expect(R"(["/materials", [{{"alphaMode": ""}}]])", "\"\" counts as absent");
    expect(R"(["/materials", [{{"normalTexture": {{}}}}]])",
           "texture without an index is left out");
    expect(R"(["/meshes/0/primitives/0/attributes/NORMAL", {empty}])",
           "attribute without elements is left out");
    expect(R"(["/meshes/0/primitives/0/targets", [{{"POSITION": {empty}}}]])",
           "attribute without elements is left out");
    expect(R"(["/skins", [{{"joints": []}}]])", "skin without joints is left out");
    expect(R"(["/animations", [{{"samplers": [{{"input": {empty}, "output": {empty}}}], "channels":
             [{{"sampler": 0, "target": {{"node": 0, "path": "scale"}}}}]}}]])",
           "animation without keys is left out");
    expect(R"(["/nodes/0/extensions", {{"EXT_mesh_gpu_instancing": {{"attributes":
             {{"TRANSLATION": {empty}}}}}}}])",
           "a mesh of no copies is left out", 1);
    expect(R"(["/extensions", {{"KHR_lights_punctual": {{"lights": [{{"intensity": 1}}]}}}}])",
           "light without a type is left out");
    expect(R"(["/extensions", {{"KHR_lights_punctual": {{"lights": [{{"type": "spot"}}]}}}}])",
           "spot light without angles has the usual ones");
    for (const char* silent :
         {R"(["/cameras", [{{"type": "orthographic", "orthographic": {{"xmag": 1, "ymag": 1}}}}]])",
          R"(["/images", [{{}}]])", R"(["/samplers", [{{"wrapS": 0}}]])",
          R"(["/nodes/0/children", [null]])", R"(["/accessors/0/sparse", {{"count": 0}}])"})
        EXPECT_TRUE(warningsOf(silent).empty()) << silent;
}

TEST(GltfRepair, ReadsNoBufferThatNothingNeeds) {
    json root = json::parse(TwoTriangles().Text());
    root["buffers"].push_back({{"uri", "missing.bin"}, {"byteLength", 100}});
    root["buffers"].push_back({{"byteLength", 0}});
    root["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 50}, {"byteLength", 50}});
    EXPECT_EQ(kFolder.ErrorOf(root.dump()), "");
    root["accessors"][0]["bufferView"] = root["bufferViews"].size() - 1;
    EXPECT_NE(kFolder.ErrorOf(root.dump()), "");
}

// Its length counts bytes, of which four are to be aligned.
TEST(GltfRepair, PadsTheChunkOfData) {
    GltfFile file = TwoTriangles();
    std::string bytes = file.Binary();
    const size_t start = bytes.size() - file.bytes.size() - 8;
    EXPECT_EQ(kFolder.ErrorOf(bytes, "a.glb"), "");
    bytes += std::string(3, '\0');
    bytes[start] = char(bytes[start] + 3);
    bytes[8] = char(bytes[8] + 3);
    EXPECT_EQ(kFolder.ErrorOf(bytes, "a.glb"), "");
    // A chunk of no data is left out.
    EXPECT_EQ(kFolder.ErrorOf(GltfFile::Glb(TwoTriangles().Text(), ""), "a.glb"), "");
}

TEST(GltfRepair, ReadsDataWithoutATypeOrSemicolon) {
    std::string text = TwoTriangles().Text();
    const std::string type = "data:application/octet-stream;base64,";
    text.replace(text.find(type), type.size(), "data:base64,");
    EXPECT_EQ(kFolder.ErrorOf(text), "");
}

// A plane scaled by 0 across it is the same plane, also where a node below turns it.
TEST(GltfRepair, ShowsWhatIsFlattened) {
    for (const bool isNested : {false, true}) {
        GltfFile file;
        json node = {{"mesh", file.Triangle()}};
        if (isNested) {
            file.Node({{"scale", {1, 1, 0}}, {"children", {1}}});
            node["rotation"] = {0, 0, 0.3826834, 0.9238795};
            file.root["nodes"].push_back(node);
        } else {
            node["scale"] = {1, 1, 0};
            file.Node(node);
        }
        EXPECT_TRUE(WarningsOf(file, 1).empty());
    }
    GltfFile line;
    line.Node({{"mesh", line.Triangle()}, {"scale", {1, 0, 0}}});
    EXPECT_EQ(WarningsOf(line, 0).count("a mesh scaled to nothing is left out"), 1u);
}

}  // namespace
}  // namespace lull
