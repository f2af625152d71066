#include "renderer/input/gltf_loader.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <cmath>
#include <filesystem>
#include <map>
#include <tuple>

#include "renderer/files/file_io.h"
#include "renderer/input/gltf/cameras.h"
#include "renderer/input/gltf/document.h"
#include "renderer/input/gltf/materials.h"
#include "renderer/input/gltf/nodes.h"
#include "renderer/input/gltf/primitives.h"

namespace lull {
namespace {

// Blender's: enough for glass behind glass; roulette ends dim paths long before.
constexpr int kMaxDepth = 12;

struct PosedMesh {
    int mesh, skin = -1;          // -1: none
    std::vector<double> weights;  // of its morph targets; empty: none
    GltfVisibility visibility;

    bool operator<(const PosedMesh& o) const {
        return std::tie(mesh, skin, weights, visibility) <
               std::tie(o.mesh, o.skin, o.weights, o.visibility);
    }
};

// Shapes of a mesh, in the world if it has a skin, and, on request, points on their outline.
struct MeshShapes {
    std::vector<ShapeEntity> shapes;
    std::vector<Vec3f> outline;
};

struct Placement {
    int node;
    Mat4d worldFromMesh;
    std::optional<Mat4d> atClose = {};  // of one that moves: the same when the shutter closes
};

MeshShapes ReadMesh(const GltfDocument& document, const std::vector<GltfNode>& nodes,
                    const PosedMesh& posed, bool withOutline, GltfMaterials* materials,
                    Warnings& warnings) {
    MeshShapes result;
    const int mesh = posed.mesh;
    const auto& primitives = document.model.meshes[size_t(mesh)].primitives;
    std::vector<Mat4d> joints;
    if (posed.skin >= 0) joints = JointMatrices(document, nodes, posed.skin);
    for (size_t i = 0; i < primitives.size(); ++i) {
        const FileLoc loc = document.At(fmt::format("/meshes/{}/primitives/{}", mesh, i));
        GltfTriangles triangles = ReadPrimitive(document, mesh, int(i), posed.weights, warnings);
        if (triangles.indices.empty()) continue;
        if (!joints.empty()) Skin(document, mesh, int(i), joints, &triangles);
        const GltfMaterial& material =
            materials->Get(primitives[i].material, !triangles.colors.empty(), warnings);
        for (size_t set : {0, 1})
            if (material.uvSets[set] && triangles.uvs[set].empty())
                warnings.Add(loc, fmt::format("a texture is misplaced, since its mesh lacks "
                                              "TEXCOORD_{}",
                                              set));
        if (material.tangentUvSet >= 0 && triangles.tangents.empty())
            MakeTangents(material.tangentUvSet, &triangles);
        if (material.tangentUvSet < 0) triangles.tangents.clear();
        if (withOutline)
            for (const Vec3f& point : OutlineOf(triangles.positions))
                result.outline.push_back(point);
        ShapeEntity shape = MakeShapeEntity(std::move(triangles), loc);
        shape.material = material.index;
        shape.areaLight = material.emission;
        const bool hasFront =
            shape.areaLight || material.coverage.Find(ParameterType::Bool, "singlesided");
        if (hasFront) ParameterWriter(&shape.parameters, loc).Bool("frontbywinding", true);
        shape.insideMedium = material.medium;
        if (material.isVolume) shape.outsideMedium = ShapeEntity::kSurrounding;
        for (const Parameter& parameter : material.coverage.All()) shape.parameters.Add(parameter);
        Hide(posed.visibility, &shape.parameters);
        result.shapes.push_back(std::move(shape));
    }
    return result;
}

PosedMesh MeshOf(const GltfDocument& document, int index) {
    const tinygltf::Node& node = document.model.nodes[size_t(index)];
    const std::vector<double>& usual = document.model.meshes[size_t(node.mesh)].weights;
    PosedMesh mesh{node.mesh, node.skin, node.weights.empty() ? usual : node.weights,
                   VisibilityOf(document, index)};
    if (std::all_of(mesh.weights.begin(), mesh.weights.end(), [](double w) { return w == 0; }))
        mesh.weights.clear();
    return mesh;
}

bool HasExtent(const Mat4d& m) {
    return m.inverse().allFinite() && m.topLeftCorner<3, 3>().determinant() != 0;
}

// Returns a transform that flattens the mesh with a millionth of its extent left across, which has
// an inverse: a flat mesh stays as it is. One onto a line or a point is returned as it is.
Mat4d Thickened(const Mat4d& m) {
    if (HasExtent(m) || !m.allFinite()) return m;
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(m.topLeftCorner<3, 3>(),
                                                Eigen::ComputeFullU | Eigen::ComputeFullV);
    Eigen::Vector3d extents = svd.singularValues();
    if (!(extents[1] > 1e-12 * extents[0])) return m;
    const double side = svd.matrixU().determinant() * svd.matrixV().determinant();
    extents[2] = std::copysign(1e-6 * extents[1], side);
    Mat4d thick = m;
    thick.topLeftCorner<3, 3>() = svd.matrixU() * extents.asDiagonal() * svd.matrixV().transpose();
    return thick;
}

bool AnyJointMoves(const GltfDocument& document, const std::vector<GltfNode>& nodes, int skin) {
    const std::vector<int>& joints = document.model.skins[size_t(skin)].joints;
    return std::any_of(nodes.begin(), nodes.end(), [&](const GltfNode& node) {
        return node.atClose && std::find(joints.begin(), joints.end(), node.index) != joints.end();
    });
}

std::map<PosedMesh, std::vector<Placement>> ListPlacements(const GltfDocument& document,
                                                           const std::vector<GltfNode>& nodes,
                                                           Warnings& warnings) {
    std::map<PosedMesh, std::vector<Placement>> placements;
    for (const GltfNode& node : nodes) {
        const tinygltf::Node& n = document.model.nodes[size_t(node.index)];
        if (n.mesh < 0 || !node.isVisible) continue;
        const FileLoc loc = document.At(fmt::format("/nodes/{}", node.index));
        const PosedMesh mesh = MeshOf(document, node.index);
        if (n.skin >= 0) {
            // Its joints alone say where it stands (3.7.3.3).
            placements[mesh].push_back({node.index, Mat4d::Identity()});
            if (n.extensions.count("EXT_mesh_gpu_instancing") > 0)
                warnings.Add(loc, "copies of a mesh with a skin are left out");
            if (AnyJointMoves(document, nodes, n.skin))
                warnings.Add(loc, "skins are not blurred by the motion of their joints");
            continue;
        }
        for (const Mat4d& copy : ReadCopies(document, node.index)) {
            Placement placement{node.index, Thickened(node.worldFromNode * copy)};
            if (node.atClose) placement.atClose = Thickened(*node.atClose * copy);
            if (HasExtent(placement.worldFromMesh) &&
                (!placement.atClose || HasExtent(*placement.atClose)))
                placements[mesh].push_back(placement);
            else
                warnings.Add(loc, "a mesh scaled to nothing is left out");
        }
    }
    return placements;
}

std::string NameOf(const GltfDocument& document, const Placement& placement) {
    const tinygltf::Node& node = document.model.nodes[size_t(placement.node)];
    return node.name.empty() ? document.model.meshes[size_t(node.mesh)].name : node.name;
}

// Puts a mesh into the world: once as it is, more often, or where it moves, as instances of an
// object. Emitters are copied instead, since every light is a triangle of the world at rest.
void AddShapes(const GltfDocument& document, MeshShapes mesh,
               const std::vector<Placement>& placements, Description* description,
               Warnings& warnings) {
    const bool moves = std::any_of(placements.begin(), placements.end(),
                                   [](const Placement& p) { return p.atClose.has_value(); });
    const bool isInstanced = placements.size() > 1 || moves;
    ObjectEntity object;
    for (ShapeEntity& shape : mesh.shapes) {
        if (isInstanced && !shape.areaLight) {
            object.shapes.push_back(std::move(shape));
            continue;
        }
        if (moves) warnings.Add(shape.loc, "moving emitters have no motion blur");
        for (size_t i = 0; i < placements.size(); ++i) {
            ShapeEntity copy = i + 1 < placements.size() ? shape : std::move(shape);
            copy.worldFromObject = placements[i].worldFromMesh;
            copy.label = NameOf(document, placements[i]);
            description->shapes.push_back(std::move(copy));
        }
    }
    if (object.shapes.empty()) return;
    const int index = document.model.nodes[size_t(placements[0].node)].mesh;
    const std::string path = fmt::format("/meshes/{}", index);
    object.loc = document.At(path);
    const std::string& name = document.model.meshes[size_t(index)].name;
    object.name = name.empty() ? path : name;
    for (const Placement& p : placements) {
        int motion = -1;
        if (p.atClose) {
            motion = int(description->motions.size());
            description->motions.push_back({TransformPair{{p.worldFromMesh, *p.atClose}}});
        }
        description->instances.push_back({int(description->objects.size()), p.worldFromMesh,
                                          document.At(fmt::format("/nodes/{}", p.node)), motion,
                                          NameOf(document, p)});
    }
    description->objects.push_back(std::move(object));
}

}  // namespace

Description ParseGltf(const std::string& file, const GltfOptions& options, Warnings& warnings) {
    GltfDocument document = ReadGltf(file, warnings);
    if (!options.variant.empty()) UseVariant(options.variant, &document);
    Description description;
    description.upAxis = 1;
    description.directory = std::filesystem::path(file).parent_path().string();
    description.variants = VariantNames(document);
    const std::vector<GltfNode> nodes = PoseNodes(options, &document, warnings);

    GltfMaterials materials(document, options.solidGlass, &description);
    std::optional<Framing> framing = FramingFor(document, nodes, options);
    for (const auto& [posed, placements] : ListPlacements(document, nodes, warnings)) {
        MeshShapes mesh =
            ReadMesh(document, nodes, posed, framing.has_value(), &materials, warnings);
        for (const Placement& p : placements)
            for (const Vec3f& point : mesh.outline) {
                framing->Extend(TransformPoint(p.worldFromMesh, point));
                if (p.atClose) framing->Extend(TransformPoint(*p.atClose, point));
            }
        AddShapes(document, std::move(mesh), placements, &description, warnings);
    }
    if (!description.media.empty()) description.integrator.name = "volpath";  // which sees them
    description.sources = {file};
    const std::vector<std::string>& files = document.bufferFiles;
    description.sources.insert(description.sources.end(), files.begin(), files.end());
    for (const GltfNode& node : nodes)
        if (node.isVisible) AddLight(document, node, &description, warnings);
    SetView(document, nodes, framing, options, &description);

    const FileLoc loc = document.At("/");
    ParameterWriter(&description.film.parameters, loc)
        .String("filename", std::filesystem::path(file).stem().string() + ".exr");
    ParameterWriter(&description.integrator.parameters, loc).Int("maxdepth", kMaxDepth);
    return description;
}

bool IsGltf(const std::string& file) {
    const std::string extension = ExtensionOf(file);
    return extension == ".gltf" || extension == ".glb";
}

}  // namespace lull
