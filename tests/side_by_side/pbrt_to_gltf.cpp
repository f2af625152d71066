// Converts a pbrt-v3 scene to a binary glTF file, so that other renderers can be compared with lull
// on it. The file looks like the scene as far as glTF's materials allow; differences cause
// warnings.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include "renderer/input/pbrt_parser.h"
#include "tests/side_by_side/materials.h"
#include "tests/side_by_side/meshes.h"
#include "tests/side_by_side/world.h"

namespace lull {
namespace {

using nlohmann::json;

// Adds a mesh of one primitive for each of these shapes; returns nothing where none is left.
std::optional<int> AddMesh(const ShapeTable& table, std::span<const ShapeEntity> entities,
                           int firstShape, const Mat4d& m, MaterialWriter* materials, GlbFile* file,
                           Warnings& warnings) {
    json primitives = json::array();
    for (size_t i = 0; i < entities.size(); ++i) {
        const Shape& shape = table.shapes[size_t(firstShape) + i];
        const int material = materials->Of(entities[i]);
        if (material < 0 || shape.IsInvisible()) continue;
        const GltfMesh mesh = MakeGltfMesh(shape, m);
        if (std::holds_alternative<Curves>(shape.geometry))
            warnings.Add(entities[i].loc, "a curve is left out");
        if (mesh.triangles.empty()) continue;
        json attributes = {{"POSITION", file->AddVectors(mesh.positions, true)}};
        if (!mesh.normals.empty()) attributes["NORMAL"] = file->AddVectors(mesh.normals, false);
        if (!mesh.uvs.empty()) attributes["TEXCOORD_0"] = file->AddVectors(mesh.uvs);
        primitives.push_back({{"attributes", attributes},
                              {"indices", file->AddIndices(mesh.triangles)},
                              {"material", material}});
    }
    if (primitives.empty()) return {};
    return file->Add("meshes", {{"primitives", primitives}});
}

void Place(int mesh, json node, GlbFile* file) {
    node["mesh"] = mesh;
    file->root["scenes"][0]["nodes"].push_back(file->Add("nodes", std::move(node)));
}

// Returns the node's transform in three parts, which glTF wants it to have; nothing if it shears.
std::optional<json> Decompose(const Mat4d& m) {
    Eigen::Matrix3d linear = m.topLeftCorner<3, 3>();
    Eigen::Vector3d scale = linear.colwise().norm().transpose();
    const Eigen::Matrix3d products = linear.transpose() * linear;
    const Eigen::Matrix3d diagonal = scale.cwiseAbs2().asDiagonal();
    if (!((products - diagonal).cwiseAbs().maxCoeff() < 1e-5 * scale.cwiseAbs2().maxCoeff()))
        return {};
    if (linear.determinant() < 0) scale.x() *= -1;
    linear = linear * scale.cwiseInverse().asDiagonal();
    const Eigen::Quaterniond turn(linear);
    return json{{"translation", {m(0, 3), m(1, 3), m(2, 3)}},
                {"rotation", {turn.x(), turn.y(), turn.z(), turn.w()}},
                {"scale", {scale.x(), scale.y(), scale.z()}}};
}

void AddShapes(const Description& description, const Mat4d& gltfFromWorld, GlbFile* file,
               Warnings& warnings) {
    const TextureTable textures(description, warnings);
    const ShapeTable table(description, textures, warnings);
    warnings.ThrowErrors();
    MaterialWriter materials(description, file, &warnings);
    for (size_t i = 0; i < description.shapes.size(); ++i)
        if (const auto mesh = AddMesh(table, std::span(description.shapes).subspan(i, 1), int(i),
                                      gltfFromWorld, &materials, file, warnings))
            Place(*mesh, json::object(), file);

    std::vector<std::optional<int>> meshes(description.objects.size());
    for (const InstanceEntity& instance : description.instances) {
        const auto object = size_t(instance.object);
        const std::span<const ShapeEntity> shapes = description.objects[object].shapes;
        const int first = table.objects[object].firstShape;
        // Instances share a mesh that is turned as the world is, unless theirs would be sheared.
        const Mat4d m = gltfFromWorld * instance.worldFromInstance * gltfFromWorld.inverse();
        const auto node = Decompose(m);
        if (!node) {
            const Mat4d all = gltfFromWorld * instance.worldFromInstance;
            if (const auto mesh = AddMesh(table, shapes, first, all, &materials, file, warnings))
                Place(*mesh, json::object(), file);
            continue;
        }
        if (!meshes[object])
            meshes[object] =
                AddMesh(table, shapes, first, gltfFromWorld, &materials, file, warnings);
        if (meshes[object]) Place(*meshes[object], *node, file);
    }
}

void Convert(const std::string& scene, const std::string& output, const std::string& environment) {
    Warnings warnings([](const std::string& message) { fmt::print(stderr, "{}\n", message); },
                      true);
    const Description description = ParsePbrt(scene, warnings);
    if (!description.motions.empty() || description.movingCameraFromWorld)
        warnings.Add({}, "what moves stands where it starts");
    const Mat4d gltfFromWorld = GltfFromWorld(description);
    GlbFile file;
    file.root["scene"] = 0;
    AddCamera(description, gltfFromWorld, &file, warnings);
    AddLights(description, gltfFromWorld, &file, warnings);
    AddShapes(description, gltfFromWorld, &file, warnings);
    warnings.Summarize();
    file.Write(output);
    if (WriteEnvironment(description, gltfFromWorld, environment)) fmt::print("{}\n", environment);
}

}  // namespace
}  // namespace lull

int main(int argc, char** argv) {
    CLI::App app("Turns a pbrt-v3 scene into glTF, for comparisons with other renderers.");
    std::string scene, output, environment;
    app.add_option("SCENE", scene, "The scene, a pbrt-v3 file")->required();
    app.add_option("OUT.glb", output, "The file to write")->required();
    app.add_option("ENVIRONMENT.exr", environment,
                   "The image to write of what surrounds the scene, if anything does; its name is\n"
                   "then printed")
        ->required();
    CLI11_PARSE(app, argc, argv);
    try {
        lull::Convert(scene, output, environment);
    } catch (const std::exception& e) {
        fmt::print(stderr, "error: {}\n", e.what());
        return 1;
    }
}
