// Checks meshes that were compressed by the libraries that glTF's extensions are made for.
#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <meshoptimizer.h>

#include "tests/renderer/input/gltf_files.h"

namespace lull {
namespace {

// Returns a file whose mesh of one triangle is compressed by Draco; with red corners as bytes,
// which nothing calls normalised, if it has colours.
GltfFile DracoFile(bool hasColors = false) {
    draco::TriangleSoupMeshBuilder builder;
    builder.Start(1);
    const draco::FaceIndex face(0);
    const int position =
        builder.AddAttribute(draco::GeometryAttribute::POSITION, 3, draco::DT_FLOAT32);
    const float corners[3][3] = {{0, 0, 0}, {2, 0, 0}, {0, 3, 0}};
    builder.SetAttributeValuesForFace(position, face, corners[0], corners[1], corners[2]);
    if (hasColors) {
        const int color = builder.AddAttribute(draco::GeometryAttribute::COLOR, 3, draco::DT_UINT8);
        const uint8_t red[3] = {255, 0, 51};
        builder.SetAttributeValuesForFace(color, face, red, red, red);
    }
    const std::unique_ptr<draco::Mesh> mesh = builder.Finalize();
    draco::Encoder encoder;
    draco::EncoderBuffer buffer;
    EXPECT_TRUE(encoder.EncodeMeshToBuffer(*mesh, &buffer).ok());

    GltfFile file;
    const int view = file.View(std::string(buffer.data(), buffer.size()));
    file.root["accessors"] = {{{"componentType", 5126}, {"count", 3}, {"type", "VEC3"}},
                              {{"componentType", 5123}, {"count", 3}, {"type", "SCALAR"}},
                              {{"componentType", 5121}, {"count", 3}, {"type", "VEC3"}}};
    const auto id = [&](draco::GeometryAttribute::Type type) {
        return mesh->GetNamedAttribute(type)->unique_id();
    };
    json accessors = {{"POSITION", 0}},
         ids = {{"POSITION", id(draco::GeometryAttribute::POSITION)}};
    if (hasColors) {
        accessors["COLOR_0"] = 2;
        ids["COLOR_0"] = id(draco::GeometryAttribute::COLOR);
    }
    const json extension = {{"bufferView", view}, {"attributes", ids}};
    file.Node({{"mesh", file.Mesh(accessors,
                                  {{"indices", 1},
                                   {"extensions", {{"KHR_draco_mesh_compression", extension}}}})}});
    file.root["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    return file;
}

TEST(GltfCompression, TakesBytesOfDracoForNormalised) {
    const Description d = kFolder.Parse(DracoFile(true));
    ASSERT_EQ(d.shapes.size(), 1u);
    const std::vector<float> colors = FloatsOf(d.shapes[0], ParameterType::Float, "color");
    ASSERT_EQ(colors.size(), 12u);
    EXPECT_NEAR(colors[0], 1, 1e-5f);
    EXPECT_NEAR(colors[2], 0.2f, 1e-5f);
}

TEST(GltfCompression, DecodesDraco) {
    Warnings warnings;
    for (const Description& d :
         {kFolder.Parse(DracoFile()),
          ParseGltf(kFolder.Write("s.glb", DracoFile().Binary()), {}, warnings)}) {
        ASSERT_EQ(d.shapes.size(), 1u);
        std::vector<float> p = FloatsOf(d.shapes[0], ParameterType::Point3, "P");
        ASSERT_EQ(p.size(), 9u);
        ASSERT_EQ(d.shapes[0].parameters.GetInts("indices").size(), 3u);
        Eigen::Vector3f sum = Eigen::Vector3f::Zero();
        for (size_t i = 0; i < 9; i += 3) sum += Eigen::Map<Eigen::Vector3f>(&p[i]);
        EXPECT_TRUE(sum.isApprox(Eigen::Vector3f(2, 3, 0), 1e-3f));
    }
    GltfFile broken = DracoFile();
    broken.bytes[9] = char(0xff);
    broken.bytes[5] = 7;
    EXPECT_NE(kFolder.ErrorOf(broken), "");
}

TEST(GltfCompression, DecodesMeshopt) {
    const std::vector<float> positions = {0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 5};
    const std::vector<uint32_t> indices = {0, 1, 2, 2, 1, 3};
    std::string vertices(meshopt_encodeVertexBufferBound(4, 12), '\0'),
        triangles(meshopt_encodeIndexBufferBound(6, 4), '\0');
    const auto bytes = [](std::string* s) { return reinterpret_cast<unsigned char*>(s->data()); };
    vertices.resize(
        meshopt_encodeVertexBuffer(bytes(&vertices), vertices.size(), positions.data(), 4, 12));
    triangles.resize(
        meshopt_encodeIndexBuffer(bytes(&triangles), triangles.size(), indices.data(), 6));

    GltfFile file;
    const auto compressed = [&](const std::string& data, const char* mode, int count, int stride) {
        const int view = file.View(data);
        json& v = file.root["bufferViews"][size_t(view)];
        v["extensions"]["EXT_meshopt_compression"] = {{"buffer", 0},
                                                      {"byteOffset", v["byteOffset"]},
                                                      {"byteLength", data.size()},
                                                      {"byteStride", stride},
                                                      {"count", count},
                                                      {"mode", mode}};
        v["buffer"] = 1;
        v["byteOffset"] = 0;
        v["byteLength"] = count * stride;
        return view;
    };
    const int p = file.Accessor(compressed(vertices, "ATTRIBUTES", 4, 12), 5126, 4, "VEC3");
    const int i = file.Accessor(compressed(triangles, "TRIANGLES", 6, 2), 5123, 6, "SCALAR");
    file.Node({{"mesh", file.Mesh({{"POSITION", p}}, {{"indices", i}})}});
    // The second buffer only stands for what is compressed in the first.
    json whole = json::parse(file.Text());
    whole["buffers"].push_back(
        {{"byteLength", 1000},
         {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}});
    Warnings warnings;
    const Description d = ParseGltf(kFolder.Write("scene.gltf", whole.dump()), {}, warnings);
    ASSERT_EQ(d.shapes.size(), 1u);
    EXPECT_EQ(FloatsOf(d.shapes[0], ParameterType::Point3, "P"), positions);
    EXPECT_EQ(d.shapes[0].parameters.GetInts("indices").size(), 6u);

    whole["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["byteLength"] = 3;
    EXPECT_EQ(kFolder.ErrorOf(whole.dump()),
              "scene.gltf: /bufferViews/0/extensions/EXT_meshopt_compression: its data are broken");
    whole["images"] = {{{"bufferView", 0}, {"mimeType", "image/png"}}};
    EXPECT_EQ(kFolder.ErrorOf(whole.dump()),
              "scene.gltf: /images/0/bufferView: is compressed, as images cannot be");
}

}  // namespace
}  // namespace lull
