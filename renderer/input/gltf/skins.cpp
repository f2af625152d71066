#include "renderer/input/gltf/skins.h"

#include <fmt/format.h>

#include "renderer/input/gltf/accessors.h"

namespace lull {
namespace {

// A set of four joints and weights for each vertex.
struct Influences {
    std::vector<float> joints, weights;
};

std::vector<Influences> ReadInfluences(const GltfDocument& document, const FileLoc& loc,
                                       const tinygltf::Primitive& primitive, size_t vertexCount) {
    std::vector<Influences> sets;
    while (true) {
        const auto joints = primitive.attributes.find(fmt::format("JOINTS_{}", sets.size()));
        const auto weights = primitive.attributes.find(fmt::format("WEIGHTS_{}", sets.size()));
        if (joints == primitive.attributes.end() || weights == primitive.attributes.end()) break;
        sets.push_back({ReadFloats(document, joints->second, 4, 4).values,
                        ReadFloats(document, weights->second, 4, 4).values});
        if (sets.back().joints.size() != 4 * vertexCount ||
            sets.back().weights.size() != 4 * vertexCount)
            throw Error(loc, fmt::format("its joints or weights are not {}, as its vertices are",
                                         vertexCount));
    }
    if (sets.empty()) throw Error(loc, "has a skin, but no JOINTS_0 and WEIGHTS_0");
    return sets;
}

// Returns the map of normals for a linear map, up to a positive factor. Unlike the transposed
// inverse it exists for every map.
Eigen::Matrix3d ForNormals(const Eigen::Matrix3d& m) {
    Eigen::Matrix3d c;
    c.col(0) = m.col(1).cross(m.col(2));
    c.col(1) = m.col(2).cross(m.col(0));
    c.col(2) = m.col(0).cross(m.col(1));
    return m.determinant() < 0 ? Eigen::Matrix3d(-c) : c;
}

// Replaces a direction by its image at unit length, unless that has none.
void Turn(const Eigen::Matrix3d& m, float* direction) {
    Eigen::Map<Vec3f> d(direction);
    const Eigen::Vector3d turned = m * d.cast<double>();
    if (const double length = turned.norm(); length > 0) d = (turned / length).cast<float>();
}

}  // namespace

std::vector<Mat4d> JointMatrices(const GltfDocument& document, const std::vector<GltfNode>& nodes,
                                 int index) {
    const tinygltf::Skin& skin = document.model.skins[size_t(index)];
    const FileLoc loc = document.At(fmt::format("/skins/{}", index));
    std::vector<float> inverseBind;
    if (skin.inverseBindMatrices >= 0)
        inverseBind = ReadFloats(document, skin.inverseBindMatrices, 16, 16).values;
    if (skin.inverseBindMatrices >= 0 && inverseBind.size() < 16 * skin.joints.size())
        throw Error(loc, fmt::format("has {} inverse bind matrices for {} joints",
                                     inverseBind.size() / 16, skin.joints.size()));
    std::vector<const GltfNode*> listed(document.model.nodes.size());
    for (const GltfNode& node : nodes) listed[size_t(node.index)] = &node;
    std::vector<Mat4d> joints;
    for (size_t i = 0; i < skin.joints.size(); ++i) {
        const GltfNode* node = listed[size_t(skin.joints[i])];
        if (!node) throw Error(loc, fmt::format("its joint {} is not in the scene", i));
        joints.push_back(node->worldFromNode);
        if (!inverseBind.empty())
            joints.back() *= Eigen::Map<const Eigen::Matrix4f>(&inverseBind[16 * i]).cast<double>();
    }
    return joints;
}

void Skin(const GltfDocument& document, int mesh, int index, const std::vector<Mat4d>& joints,
          GltfTriangles* t) {
    const tinygltf::Primitive& primitive =
        document.model.meshes[size_t(mesh)].primitives[size_t(index)];
    const FileLoc loc = document.At(fmt::format("/meshes/{}/primitives/{}", mesh, index));
    const std::vector<Influences> sets = ReadInfluences(document, loc, primitive, t->VertexCount());
    for (size_t v = 0; v < t->VertexCount(); ++v) {
        Mat4d blended = Mat4d::Zero();
        double sum = 0;
        for (const Influences& set : sets)
            for (size_t k = 4 * v; k < 4 * v + 4; ++k) {
                if (set.weights[k] == 0) continue;
                const float joint = set.joints[k];
                if (!(joint >= 0 && size_t(joint) < joints.size()))
                    throw Error(loc, fmt::format("vertex {} has joint {}, but its skin has {}", v,
                                                 joint, joints.size()));
                blended += double(set.weights[k]) * joints[size_t(joint)];
                sum += double(set.weights[k]);
            }
        blended = sum != 0 ? Mat4d(blended / sum) : joints.at(0);
        const Eigen::Matrix3d linear = blended.topLeftCorner<3, 3>();
        Eigen::Map<Vec3f> p(&t->positions[3 * v]);
        p = (linear * p.cast<double>() + blended.topRightCorner<3, 1>()).cast<float>();
        if (!p.allFinite()) throw Error(loc, fmt::format("its skin takes vertex {} too far", v));
        if (!t->normals.empty()) Turn(ForNormals(linear), &t->normals[3 * v]);
        if (!t->tangents.empty()) Turn(linear, &t->tangents[4 * v]);
    }
}

}  // namespace lull
