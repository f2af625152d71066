// Files that break the specification where it does no harm.
#include "tests/renderer/input/gltf_files.h"

namespace lull {
namespace {

// Returns a file with two triangles, each a mesh of its own.
GltfFile TwoTriangles() {
    GltfFile file;
    file.Node({{"mesh", file.Triangle()}});
    file.Node({{"mesh", file.Triangle()}});
    return file;
}

// Returns the warnings of a file that has to have `shapes` shapes.
std::map<std::string, int> WarningsOf(const GltfFile& file, size_t shapes) {
    const GltfFolder folder;
    Warnings warnings;
    EXPECT_EQ(folder.Parse(file, {}, &warnings).shapes.size(), shapes);
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

TEST(GltfRepair, TakesADistanceOf0ForInfinity) {
    GltfFile file = TwoTriangles();
    file.root["materials"] = {
        {{"extensions",
          {{"KHR_materials_volume",
            {{"attenuationDistance", 0}, {"attenuationColor", {0.5, 0.5, 0.5}}}}}}}};
    file.root["meshes"][0]["primitives"][0]["material"] = 0;
    EXPECT_EQ(WarningsOf(file, 2).count("an attenuationDistance of 0 counts as absent"), 1u);
}

TEST(GltfRepair, LeavesOutWhatIsEmpty) {
    GltfFile file = TwoTriangles();
    file.root["accessors"][1]["count"] = 0;
    EXPECT_EQ(WarningsOf(file, 1).count("primitive without vertices or indices is left out"), 1u);
    file = TwoTriangles();
    file.root["bufferViews"][1]["byteLength"] = 0;
    EXPECT_EQ(WarningsOf(file, 1).count("primitive without vertices or indices is left out"), 1u);
    file = TwoTriangles();
    file.root["accessors"].push_back({{"componentType", 5123}, {"count", 0}, {"type", "SCALAR"}});
    file.root["meshes"][1]["primitives"][0]["indices"] = 2;
    EXPECT_EQ(WarningsOf(file, 1).count("primitive without vertices or indices is left out"), 1u);
    file = TwoTriangles();
    file.root["meshes"][1].erase("primitives");
    EXPECT_EQ(WarningsOf(file, 1).count("mesh without primitives is left out"), 1u);
}

// An animation of no keys is none that could be left out without a change.
TEST(GltfRepair, RefusesWhatIsReadAndEmpty) {
    GltfFile file = TwoTriangles();
    const int empty = file.Accessor(0, 5126, 1, "SCALAR");
    file.root["accessors"][size_t(empty)]["count"] = 0;
    file.root["animations"] = {
        {{"samplers", {{{"input", empty}, {"output", 0}}}},
         {"channels", {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
    EXPECT_NE(GltfFolder().ErrorOf(file), "");
}

TEST(GltfRepair, ReadsNoBufferThatNothingNeeds) {
    const GltfFolder folder;
    json root = json::parse(TwoTriangles().Text());
    root["buffers"].push_back({{"uri", "missing.bin"}, {"byteLength", 100}});
    root["buffers"].push_back({{"byteLength", 0}});
    root["bufferViews"].push_back({{"buffer", 1}, {"byteOffset", 50}, {"byteLength", 50}});
    EXPECT_EQ(folder.ErrorOf(root.dump()), "");
    root["accessors"][0]["bufferView"] = root["bufferViews"].size() - 1;
    EXPECT_NE(folder.ErrorOf(root.dump()), "");
}

// Its length counts bytes, of which four are to be aligned.
TEST(GltfRepair, PadsTheChunkOfData) {
    const GltfFolder folder;
    GltfFile file = TwoTriangles();
    std::string bytes = file.Binary();
    const size_t start = bytes.size() - file.bytes.size() - 8;
    EXPECT_EQ(folder.ErrorOf(bytes, "a.glb"), "");
    bytes += std::string(3, '\0');
    bytes[start] = char(bytes[start] + 3);
    bytes[8] = char(bytes[8] + 3);
    EXPECT_EQ(folder.ErrorOf(bytes, "a.glb"), "");
}

TEST(GltfRepair, LeavesOutAChunkOfNoData) {
    const std::string bytes = GltfFile::Glb(TwoTriangles().Text(), "");
    EXPECT_EQ(GltfFolder().ErrorOf(bytes, "a.glb"), "");
}

TEST(GltfRepair, ReadsDataWithoutATypeOrSemicolon) {
    std::string text = TwoTriangles().Text();
    const std::string type = "data:application/octet-stream;base64,";
    text.replace(text.find(type), type.size(), "data:base64,");
    EXPECT_EQ(GltfFolder().ErrorOf(text), "");
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
