// Checks what becomes of the arrays of glTF files.
#include <functional>

#include "tests/renderer/input/gltf_files.h"

namespace lull {
namespace {

std::vector<int> Indices(const Description& d) {
    const auto values = d.shapes.at(0).parameters.GetInts("indices");
    return {values.begin(), values.end()};
}

TEST(GltfMeshes, ComeFromTextAndBinaryAlike) {
    const GltfFile file = OneTriangle();
    const Description text = kFolder.Parse(file);
    Warnings warnings;
    const Description binary = ParseGltf(kFolder.Write("scene.glb", file.Binary()), {}, warnings);
    ExpectNear(Positions(text), {0, 0, 0, 1, 0, 0, 0, 1, 0}, 0);
    EXPECT_EQ(Positions(text), Positions(binary));
    ExpectNear(Indices(binary), {0, 1, 2}, 0);
    EXPECT_EQ(text.shapes[0].name, "trianglemesh");
    EXPECT_EQ(warnings.Total(), 0);
}

TEST(GltfMeshes, ReadStridesAndOffsets) {
    // Positions and normals side by side, after four bytes of something else.
    std::vector<float> values = {7};
    for (int i = 0; i < 3; ++i)
        for (const float v : {float(i), float(i * i), 2.f, 0.f, 0.f, 1.f}) values.push_back(v);
    GltfFile file;
    const int view = file.View(values, 24);
    const int position = file.Accessor(view, 5126, 3, "VEC3", {{"byteOffset", 4}});
    const int normal = file.Accessor(view, 5126, 3, "VEC3", {{"byteOffset", 16}});
    file.Node({{"mesh", file.Mesh({{"POSITION", position}, {"NORMAL", normal}})}});
    const Description d = kFolder.Parse(file);
    ExpectNear(Positions(d), {0, 0, 2, 1, 1, 2, 2, 4, 2}, 0);
    ExpectNear(FloatsOf(d.shapes[0], ParameterType::Normal, "N"), {0, 0, 1, 0, 0, 1, 0, 0, 1}, 0);
}

TEST(GltfMeshes, ReadQuantizedAndNormalizedNumbers) {
    GltfFile file;
    const int position = file.Accessor(
        file.View(std::vector<int16_t>{0, 0, 0, 0, 32767, -32768, 0, 0, 0, 16384, 0, 0}, 8), 5122,
        3, "VEC3", {{"normalized", true}});
    const int uv =
        file.Accessor(file.View(std::vector<uint8_t>{0, 255, 0, 0, 51, 0, 0, 0, 255, 102}, 4), 5121,
                      3, "VEC2", {{"normalized", true}});
    const int color = file.Accessor(
        file.View(std::vector<uint16_t>{65535, 0, 13107, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 8), 5123, 3,
        "VEC3", {{"normalized", true}});
    file.Node(
        {{"mesh", file.Mesh({{"POSITION", position}, {"TEXCOORD_0", uv}, {"COLOR_0", color}})}});
    const Description d = kFolder.Parse(file);
    ExpectNear(Positions(d), {0.f, 0.f, 0.f, 1.f, -1.f, 0.f, 0.f, 16384 / 32767.f, 0.f});
    // v grows upwards once read.
    ExpectNear(FloatsOf(d.shapes[0], ParameterType::Float, "uv"), {0.f, 0.f, 0.2f, 1.f, 1.f, 0.6f});
    const std::vector<float> colors = FloatsOf(d.shapes[0], ParameterType::Float, "color");
    ExpectNear(std::vector<float>(colors.begin(), colors.begin() + 4), {1.f, 0.f, 0.2f, 1.f});
}

// Only colours and texture coordinates can be nothing else.
TEST(GltfMeshes, NormalizeIntegersThatDoNotSayThatTheyAre) {
    for (const bool isQuantized : {false, true}) {
        GltfFile file;
        const int uv = file.Accessor(file.View(std::vector<uint16_t>{0, 65535, 0, 0, 65535, 0}),
                                     5123, 3, "VEC2");
        const int color = file.Accessor(
            file.View(std::vector<uint8_t>{51, 102, 153, 255, 0, 0, 0, 0, 0, 0, 0, 0}), 5121, 3,
            "VEC4");
        const int position = file.Floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3");
        file.Node({{"mesh",
                    file.Mesh({{"POSITION", position}, {"TEXCOORD_0", uv}, {"COLOR_0", color}})}});
        if (isQuantized) file.root["extensionsUsed"] = {"KHR_mesh_quantization"};
        Warnings warnings;
        const Description d = kFolder.Parse(file, {}, &warnings);
        const std::vector<float> colors = FloatsOf(d.shapes[0], ParameterType::Float, "color");
        ExpectNear(std::vector<float>(colors.begin(), colors.begin() + 4), {.2, .4, .6, 1});
        const double most = isQuantized ? 65535 : 1;
        ExpectNear(FloatsOf(d.shapes[0], ParameterType::Float, "uv"), {0, 1 - most, 0, 1, most, 1});
        EXPECT_EQ(warnings.Total(), isQuantized ? 1 : 2);
    }
}

TEST(GltfMeshes, ReplaceSparseValues) {
    GltfFile file;
    const int indices = file.View(std::vector<uint8_t>{1, 2});
    const int values = file.View(std::vector<float>{5, 6, 7, 8, 9, 10});
    const json sparse = {{"count", 2},
                         {"indices", {{"bufferView", indices}, {"componentType", 5121}}},
                         {"values", {{"bufferView", values}}}};
    const int full =
        file.Accessor(file.View(std::vector<float>(9, 3)), 5126, 3, "VEC3", {{"sparse", sparse}});
    file.root["accessors"].push_back(
        {{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}, {"sparse", sparse}});
    file.Node({{"mesh", file.Mesh({{"POSITION", full}})}});
    file.Node({{"mesh", file.Mesh({{"POSITION", full + 1}})}});
    const Description d = kFolder.Parse(file);
    ExpectNear(Positions(d, 0), {3, 3, 3, 5, 6, 7, 8, 9, 10}, 0);
    ExpectNear(Positions(d, 1), {0, 0, 0, 5, 6, 7, 8, 9, 10}, 0);
}

TEST(GltfMeshes, ReplaceSparseIndices) {
    GltfFile file;
    const json sparse = {
        {"count", 1},
        {"indices", {{"bufferView", file.View(std::vector<uint8_t>{2})}, {"componentType", 5121}}},
        {"values", {{"bufferView", file.View(std::vector<uint16_t>{1})}}}};
    const int full = file.Accessor(file.View(std::vector<uint16_t>{2, 0, 0}), 5123, 3, "SCALAR",
                                   {{"sparse", sparse}});
    file.Node({{"mesh", file.Triangle({{"indices", full}})}});
    ExpectNear(Indices(kFolder.Parse(file)), {2, 0, 1}, 0);
    file.root["accessors"][size_t(full)]["sparse"]["values"]["bufferView"] =
        file.View(std::vector<uint16_t>{3});
    EXPECT_EQ(kFolder.ErrorOf(file),
              "scene.gltf: /accessors/0: index 3 is out of range: there are 3 vertices");
    file.root["accessors"][size_t(full)]["sparse"]["indices"]["bufferView"] =
        file.View(std::vector<uint8_t>{3});
    EXPECT_EQ(kFolder.ErrorOf(file),
              "scene.gltf: /accessors/0: sparse index 3 is out of range: there are 3 elements");
}

// Some exporters write a stride of 0 for elements that follow each other.
TEST(GltfMeshes, FollowEachOtherWithAStrideOfZero) {
    GltfFile file = OneTriangle();
    file.root["bufferViews"][0]["byteStride"] = 0;
    ExpectNear(Positions(kFolder.Parse(file)), {0, 0, 0, 1, 0, 0, 0, 1, 0}, 0);
}

// 4.0 and 4e0 are the integer 4, as in other readers of JSON.
TEST(GltfMeshes, ReadWholeNumbersThatAreWrittenAsFractions) {
    GltfFile file;
    file.root["materials"] = {{{"emissiveFactor", {1, 1, 1}}}};
    file.Node({{"mesh", file.Triangle({{"indices", file.Indices({0, 2, 1})}, {"material", 0}})}});
    json root = json::parse(file.Text());
    const std::function<void(json&)> toFractions = [&](json& value) {
        if (value.is_number()) value = value.get<double>();
        if (value.is_structured())
            for (json& member : value) toFractions(member);
    };
    toFractions(root);
    std::string fractions = root.dump();
    for (size_t at; (at = fractions.find("5126.0")) != std::string::npos;)
        fractions.replace(at, 6, "5.126e3");
    EXPECT_HAS(fractions, "\"mesh\":0.0");
    Warnings warnings;
    const Description d = ParseGltf(kFolder.Write("scene.gltf", fractions), {}, warnings);
    ExpectNear(Positions(d), {0, 0, 0, 1, 0, 0, 0, 1, 0}, 0);
    ExpectNear(Indices(d), {0, 2, 1}, 0);
    EXPECT_TRUE(d.shapes.at(0).areaLight);
    EXPECT_EQ(warnings.Total(), 0);
}

// The data of a buffer may be longer than it says (3.6.1.1).
TEST(GltfMeshes, LieInLongerFiles) {
    const GltfFile file = OneTriangle();
    json root = json::parse(file.Text());
    root["buffers"][0]["uri"] =
        "data:application/octet-stream;base64," + Base64(file.bytes + "more");
    EXPECT_EQ(kFolder.ErrorOf(root.dump()), "");
    kFolder.Write("a mesh.bin", file.bytes + "more");
    root["buffers"][0]["uri"] = "a%20mesh.bin";
    EXPECT_EQ(kFolder.ErrorOf(root.dump()), "");
    kFolder.Write("a mesh.bin", file.bytes.substr(1));
    EXPECT_NE(kFolder.ErrorOf(root.dump()), "");
}

TEST(GltfMeshes, UnrollStripsAndFans) {
    const auto indices = [](int mode) {
        GltfFile file;
        const int p = file.Floats(std::vector<float>(15, 1), "VEC3");
        file.Node(
            {{"mesh", file.Mesh({{"POSITION", p}},
                                {{"mode", mode}, {"indices", file.Indices({0, 1, 2, 3, 4})}})}});
        return Indices(kFolder.Parse(file));
    };
    ExpectNear(indices(4), {0, 1, 2}, 0);
    ExpectNear(indices(5), {0, 1, 2, 1, 3, 2, 2, 3, 4}, 0);
    ExpectNear(indices(6), {1, 2, 0, 2, 3, 0, 3, 4, 0}, 0);
}

TEST(GltfMeshes, LeaveOutCornersOfNoTriangle) {
    GltfFile file;
    file.Node({{"mesh", file.Triangle({{"indices", file.Indices({0, 1, 2, 1, 2})}})}});
    Warnings warnings;
    ExpectNear(Indices(kFolder.Parse(file, {}, &warnings)), {0, 1, 2}, 0);
    EXPECT_EQ(warnings.Counts().at("the last corners, which make up no triangle, are left out"), 1);
}

TEST(GltfMeshes, LeaveOutPointsAndLines) {
    Warnings warnings;
    EXPECT_TRUE(kFolder.Parse(OneTriangle({{"mode", 1}}), {}, &warnings).shapes.empty());
    EXPECT_EQ(warnings.Counts().count("points and lines are left out"), 1u);
}

void AddNormalMap(GltfFile* file) {
    file->root["images"] = {{{"uri", "normals.png"}}};
    file->root["textures"] = {{{"source", 0}}};
    file->root["materials"] = {{{"normalTexture", {{"index", 0}}}}};
}

// Adds a quad in the plane z = 0 whose material has a normal map; u runs along x, or against it.
Description MappedQuad(bool isMirrored, const std::vector<float>& tangents = {}) {
    GltfFile file;
    const int p = file.Floats({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
    const int n = file.Floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const float a = isMirrored ? 1 : 0;
    const int uv = file.Floats({a, 1, 1 - a, 1, 1 - a, 0, a, 0}, "VEC2");
    AddNormalMap(&file);
    json attributes = {{"POSITION", p}, {"NORMAL", n}, {"TEXCOORD_0", uv}};
    if (!tangents.empty()) attributes["TANGENT"] = file.Floats(tangents, "VEC4");
    file.Node({{"mesh", file.Mesh(attributes, {{"indices", file.Indices({0, 1, 2, 0, 2, 3})},
                                               {"material", 0}})}});
    return kFolder.Parse(file);
}

// Also where those of the file are none.
TEST(GltfMeshes, MakeTangentsAlongTheTexture) {
    for (const bool isMirrored : {false, true})
        for (const std::vector<float>& tangents :
             {std::vector<float>{},
              std::vector<float>(16, 0.f),
              {0, 1, 0, 1, 0, 0, 1, 1, 0, 1, 0, 1, 0, 1, 0, 1}}) {
            const Description d = MappedQuad(isMirrored, tangents);
            const std::vector<float> t = FloatsOf(d.shapes[0], ParameterType::Float, "tangent");
            ASSERT_EQ(t.size(), 16u);
            const float side = isMirrored ? -1.f : 1.f;
            for (size_t i = 0; i < 16; i += 4)
                ExpectNear(std::vector<float>(t.begin() + long(i), t.begin() + long(i) + 4),
                           {side, 0.f, 0.f, side});
        }
}

// Two triangles share an edge; the texture of one is the mirror image of the other's.
TEST(GltfMeshes, SplitVerticesWhereTheTextureIsMirrored) {
    GltfFile file;
    const int p = file.Floats({0, 0, 0, 1, 0, 0, 0, 1, 0, -1, 0, 0}, "VEC3");
    const int n = file.Floats({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const int uv = file.Floats({0, 1, 1, 1, 0, 0, 1, 1}, "VEC2");
    AddNormalMap(&file);
    file.Node(
        {{"mesh", file.Mesh({{"POSITION", p}, {"NORMAL", n}, {"TEXCOORD_0", uv}},
                            {{"indices", file.Indices({0, 1, 2, 0, 2, 3})}, {"material", 0}})}});
    const Description d = kFolder.Parse(file);
    EXPECT_EQ(Positions(d).size(), 6u * 3);
    ExpectNear(Indices(d), {0, 1, 2, 4, 5, 3}, 0);
    const std::vector<float> t = FloatsOf(d.shapes[0], ParameterType::Float, "tangent");
    ASSERT_EQ(t.size(), 24u);
    EXPECT_NEAR(t[0], 1, 1e-6);
    EXPECT_EQ(t[3], 1);
    EXPECT_NEAR(t[4 * 4], -1, 1e-6);
    EXPECT_EQ(t[4 * 4 + 3], -1);
}

}  // namespace
}  // namespace lull
