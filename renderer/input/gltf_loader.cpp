#include "renderer/input/gltf_loader.h"

#include <fmt/format.h>

#include <filesystem>

#include "renderer/input/gltf/cameras.h"
#include "renderer/input/gltf/document.h"
#include "renderer/input/gltf/lights.h"
#include "renderer/input/gltf/materials.h"
#include "renderer/input/gltf/nodes.h"
#include "renderer/input/gltf/parameters.h"
#include "renderer/input/gltf/primitives.h"

namespace lull {
namespace {

// Blender's: enough for glass behind glass; roulette ends dim paths long before.
constexpr int kMaxDepth = 12;

// Holds what a mesh becomes: shapes in its own space, and where they end.
struct MeshShapes {
    std::vector<ShapeEntity> shapes;
    Bounds3f bounds;
};

// Holds one place where a mesh stands.
struct Placement {
    int mesh, node;
    Mat4d worldFromMesh;
};

Bounds3f BoundsOf(const std::vector<float>& positions) {
    Bounds3f bounds;
    for (size_t i = 0; i < positions.size(); i += 3)
        bounds.Extend(Vec3f(positions[i], positions[i + 1], positions[i + 2]));
    return bounds;
}

MeshShapes ReadMesh(const GltfDocument& document, int mesh, GltfMaterials* materials,
                    Warnings& warnings) {
    MeshShapes result;
    const auto& primitives = document.model.meshes[size_t(mesh)].primitives;
    for (size_t i = 0; i < primitives.size(); ++i) {
        const FileLoc loc = document.At(fmt::format("/meshes/{}/primitives/{}", mesh, i));
        GltfTriangles triangles = ReadPrimitive(document, mesh, int(i), warnings);
        if (triangles.indices.empty()) continue;
        const GltfMaterial& material =
            materials->Get(primitives[i].material, !triangles.colors.empty(), warnings);
        if (material.tangentUvSet >= 0 && triangles.tangents.empty())
            MakeTangents(material.tangentUvSet, &triangles);
        if (material.tangentUvSet < 0) triangles.tangents.clear();
        result.bounds.Extend(BoundsOf(triangles.positions));
        ShapeEntity shape = MakeShapeEntity(std::move(triangles), loc);
        shape.material = material.index;
        shape.areaLight = material.emission;
        for (const Parameter& parameter : material.coverage.All()) shape.parameters.Add(parameter);
        result.shapes.push_back(std::move(shape));
    }
    return result;
}

// Lists where meshes stand, without those that have been flattened to nothing.
std::vector<Placement> ListPlacements(const GltfDocument& document,
                                      const std::vector<GltfNode>& nodes, Warnings& warnings) {
    std::vector<Placement> placements;
    for (const GltfNode& node : nodes) {
        const tinygltf::Node& n = document.model.nodes[size_t(node.index)];
        if (n.mesh < 0) continue;
        const FileLoc loc = document.At(fmt::format("/nodes/{}", node.index));
        if (n.skin >= 0)
            warnings.Add(loc, "a skin is left out: its mesh stands as it was modelled");
        for (const Mat4d& copy : ReadCopies(document, node.index)) {
            const Mat4d m = node.worldFromNode * copy;
            if (m.inverse().allFinite() && m.topLeftCorner<3, 3>().determinant() != 0)
                placements.push_back({n.mesh, node.index, m});
            else
                warnings.Add(loc, "a mesh scaled to nothing is left out");
        }
    }
    return placements;
}

Bounds3f Transformed(const Mat4d& m, const Bounds3f& b) {
    Bounds3f bounds;
    for (int corner = 0; corner < 8 && !b.IsEmpty(); ++corner)
        bounds.Extend(TransformPoint(
            m, Vec3f(corner & 1 ? b.lower.x() : b.upper.x(), corner & 2 ? b.lower.y() : b.upper.y(),
                     corner & 4 ? b.lower.z() : b.upper.z())));
    return bounds;
}

// Returns the name of the node or, if it has none, of the mesh; can be empty.
std::string NameOf(const GltfDocument& document, const Placement& placement) {
    const std::string& name = document.model.nodes[size_t(placement.node)].name;
    return name.empty() ? document.model.meshes[size_t(placement.mesh)].name : name;
}

// Puts a mesh into the world: once as it is, more often as instances of an object. What emits is
// copied instead, since every light is a triangle of the world.
void AddShapes(const GltfDocument& document, MeshShapes mesh,
               const std::vector<Placement>& placements, Description* description) {
    const bool isInstanced = placements.size() > 1;
    ObjectEntity object;
    for (ShapeEntity& shape : mesh.shapes) {
        if (isInstanced && !shape.areaLight) {
            object.shapes.push_back(std::move(shape));
            continue;
        }
        for (size_t i = 0; i < placements.size(); ++i) {
            ShapeEntity copy = i + 1 < placements.size() ? shape : std::move(shape);
            copy.worldFromObject = placements[i].worldFromMesh;
            copy.label = NameOf(document, placements[i]);
            description->shapes.push_back(std::move(copy));
        }
    }
    if (object.shapes.empty()) return;
    const std::string path = fmt::format("/meshes/{}", placements[0].mesh);
    object.loc = document.At(path);
    const std::string& name = document.model.meshes[size_t(placements[0].mesh)].name;
    object.name = name.empty() ? path : name;
    for (const Placement& p : placements)
        description->instances.push_back({int(description->objects.size()), p.worldFromMesh,
                                          document.At(fmt::format("/nodes/{}", p.node))});
    description->objects.push_back(std::move(object));
}

}  // namespace

Description ParseGltf(const std::string& file, const GltfOptions& options, Warnings& warnings) {
    const GltfDocument document = ReadGltf(file, warnings);
    Description description;
    description.upAxis = 1;
    description.directory = std::filesystem::path(file).parent_path().string();
    const std::vector<GltfNode> nodes = ListNodes(document);

    std::vector<std::vector<Placement>> byMesh(document.model.meshes.size());
    for (const Placement& p : ListPlacements(document, nodes, warnings))
        byMesh[size_t(p.mesh)].push_back(p);
    GltfMaterials materials(document, &description);
    Bounds3f bounds;
    for (size_t i = 0; i < byMesh.size(); ++i) {
        if (byMesh[i].empty()) continue;
        MeshShapes mesh = ReadMesh(document, int(i), &materials, warnings);
        for (const Placement& p : byMesh[i])
            bounds.Extend(Transformed(p.worldFromMesh, mesh.bounds));
        AddShapes(document, std::move(mesh), byMesh[i], &description);
    }
    description.sources = {file};
    for (const tinygltf::Buffer& buffer : document.model.buffers)
        if (!buffer.uri.empty() && !buffer.uri.starts_with("data:"))
            description.sources.push_back(ResolvePath(description, buffer.uri));
    for (const GltfNode& node : nodes) AddLight(document, node, &description, warnings);
    SetView(document, nodes, bounds, options, &description);

    const FileLoc loc = document.At("/");
    ParameterWriter(&description.film.parameters, loc)
        .String("filename", std::filesystem::path(file).stem().string() + ".exr");
    ParameterWriter(&description.integrator.parameters, loc).Int("maxdepth", kMaxDepth);
    return description;
}

bool IsGltf(const std::string& file) {
    std::string extension = std::filesystem::path(file).extension().string();
    for (char& c : extension) c = char(std::tolower(static_cast<unsigned char>(c)));
    return extension == ".gltf" || extension == ".glb";
}

}  // namespace lull
