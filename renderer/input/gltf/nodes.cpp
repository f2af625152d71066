#include "renderer/input/gltf/nodes.h"

#include <fmt/format.h>

#include "renderer/base/math.h"
#include "renderer/input/gltf/accessors.h"
#include "renderer/input/gltf/json_at.h"
#include "renderer/input/gltf/materials.h"

namespace lull {
namespace {

std::string PathOf(int node) { return fmt::format("/nodes/{}", node); }

Mat4d LocalMatrix(const GltfDocument& document, int index) {
    const tinygltf::Node& node = document.model.nodes[size_t(index)];
    Mat4d m;
    if (node.matrix.size() == 16) {
        m = Eigen::Map<const Mat4d>(node.matrix.data());  // columns first, both
        const Eigen::RowVector4d affine(0, 0, 0, 1);
        if (!((m.row(3) - affine).cwiseAbs().maxCoeff() <= kRounding))
            throw Error(document.At(PathOf(index) + "/matrix"), "is not affine");
        m.row(3) = affine;
    } else {
        const auto three = [](const std::vector<double>& v, double otherwise) {
            return v.size() == 3 ? Eigen::Vector3d(v[0], v[1], v[2])
                                 : Eigen::Vector3d(otherwise, otherwise, otherwise);
        };
        const Eigen::Vector4d rotation = node.rotation.size() == 4
                                             ? Eigen::Vector4d(node.rotation[0], node.rotation[1],
                                                               node.rotation[2], node.rotation[3])
                                             : Eigen::Vector4d(0, 0, 0, 1);
        m = MatrixOf(three(node.translation, 0), rotation, three(node.scale, 1));
    }
    return m;
}

bool SaysVisible(const tinygltf::Node& node) {
    const auto found = node.extensions.find("KHR_node_visibility");
    if (found == node.extensions.end() || !found->second.Has("visible")) return true;
    return found->second.Get("visible").Get<bool>();
}

// Returns the nodes that no other has as a child.
std::vector<int> Roots(const tinygltf::Model& model) {
    if (!model.scenes.empty()) {
        const int scene = std::max(model.defaultScene, 0);
        return model.scenes[size_t(scene)].nodes;
    }
    std::vector<bool> isChild(model.nodes.size());
    for (const tinygltf::Node& node : model.nodes)
        for (const int child : node.children) isChild[size_t(child)] = true;
    std::vector<int> roots;
    for (size_t i = 0; i < isChild.size(); ++i)
        if (!isChild[i]) roots.push_back(int(i));
    return roots;
}

}  // namespace

Mat4d MatrixOf(const Eigen::Vector3d& translation, const Eigen::Vector4d& rotation,
               const Eigen::Vector3d& scale) {
    Mat4d m = Mat4d::Identity();
    const double length = rotation.norm();
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    if (length > 0) {
        const Eigen::Vector4d q = rotation / length;
        turn = Eigen::Quaterniond(q[3], q[0], q[1], q[2]).toRotationMatrix();
    }
    m.topLeftCorner<3, 3>() = turn * scale.asDiagonal();
    m.topRightCorner<3, 1>() = translation;
    return m;
}

std::vector<GltfNode> ListNodes(const GltfDocument& document) {
    std::vector<GltfNode> nodes;
    std::vector<bool> isListed(document.model.nodes.size());
    const auto add = [&](int index, const GltfNode& parent) {
        if (isListed[size_t(index)])
            throw Error(document.At(PathOf(index)), "has two parents, or is its own ancestor");
        isListed[size_t(index)] = true;
        const bool isVisible = parent.isVisible && SaysVisible(document.model.nodes[size_t(index)]);
        nodes.push_back(
            {index, parent.worldFromNode * LocalMatrix(document, index), {}, isVisible});
        if (!(nodes.back().worldFromNode.cwiseAbs().maxCoeff() < 1e30))
            throw Error(document.At(PathOf(index)), "its transform is too large");
    };
    for (const int root : Roots(document.model)) add(root, GltfNode());
    // The list grows as it is walked; its present nodes do not move, as copies are taken.
    for (size_t i = 0; i < nodes.size(); ++i) {
        const GltfNode node = nodes[i];
        for (const int child : document.model.nodes[size_t(node.index)].children) add(child, node);
    }
    return nodes;
}

std::vector<Mat4d> ReadCopies(const GltfDocument& document, int index) {
    const tinygltf::Node& node = document.model.nodes[size_t(index)];
    const auto extension = node.extensions.find("EXT_mesh_gpu_instancing");
    if (extension == node.extensions.end()) return {Mat4d::Identity()};
    const tinygltf::Value& attributes = extension->second.Get("attributes");
    const FileLoc loc = document.At(PathOf(index) + "/extensions/EXT_mesh_gpu_instancing");
    size_t count = 0;
    const auto read = [&](const std::string& name, int least, int most) {
        GltfArray array;
        if (!attributes.Has(name)) return array;
        array = ReadFloats(document, attributes.Get(name).GetNumberAsInt(), least, most);
        if (count > 0 && array.Count() != count)
            throw Error(loc, "its attributes have different counts");
        count = array.Count();
        return array;
    };
    const GltfArray translations = read("TRANSLATION", 3, 3), rotations = read("ROTATION", 4, 4),
                    scales = read("SCALE", 3, 3);
    // Those of other names count the copies as well.
    for (const std::string& name : attributes.Keys())
        if (name != "TRANSLATION" && name != "ROTATION" && name != "SCALE") read(name, 1, 16);
    std::vector<Mat4d> copies;
    for (size_t i = 0; i < count; ++i) {
        const auto three = [&](const GltfArray& a, double otherwise) -> Eigen::Vector3d {
            if (a.values.empty()) return Eigen::Vector3d::Constant(otherwise);
            return Eigen::Map<const Vec3f>(&a.values[3 * i]).cast<double>();
        };
        Eigen::Vector4d rotation(0, 0, 0, 1);
        if (!rotations.values.empty())
            for (size_t c = 0; c < 4; ++c) rotation[long(c)] = rotations.values[4 * i + c];
        copies.push_back(MatrixOf(three(translations, 0), rotation, three(scales, 1)));
    }
    return copies;
}

namespace {

constexpr const char* kExtension = "KHR_materials_variants";

}  // namespace

std::vector<std::string> VariantNames(const GltfDocument& document) {
    std::vector<std::string> names;
    const auto extension = document.model.extensions.find(kExtension);
    if (extension == document.model.extensions.end()) return names;
    const tinygltf::Value& variants = extension->second.Get("variants");
    for (size_t i = 0; i < variants.ArrayLen(); ++i)
        names.push_back(variants.Get(i).Get("name").Get<std::string>());
    return names;
}

void UseVariant(const std::string& wanted, GltfDocument* document) {
    const auto variant = int(ChooseByName(*document, "variant", VariantNames(*document), wanted));
    const auto isMeant = [&](const tinygltf::Value& mapping) {
        const tinygltf::Value& variants = mapping.Get("variants");
        for (size_t i = 0; i < variants.ArrayLen(); ++i)
            if (variants.Get(i).GetNumberAsInt() == variant) return true;
        return false;
    };
    for (tinygltf::Mesh& mesh : document->model.meshes)
        for (tinygltf::Primitive& primitive : mesh.primitives) {
            const auto extension = primitive.extensions.find(kExtension);
            if (extension == primitive.extensions.end()) continue;
            const tinygltf::Value& mappings = extension->second.Get("mappings");
            for (size_t i = 0; i < mappings.ArrayLen(); ++i)
                if (isMeant(mappings.Get(i)))
                    primitive.material = mappings.Get(i).Get("material").GetNumberAsInt();
        }
}

GltfVisibility VisibilityOf(const GltfDocument& document, const tinygltf::Value& extras,
                            const std::string& path) {
    return {OwnFlag(document, extras, "hiddenFromCamera", path),
            OwnFlag(document, extras, "castsNoShadow", path)};
}

GltfVisibility VisibilityOf(const GltfDocument& document, int node) {
    return VisibilityOf(document, document.model.nodes[size_t(node)].extras,
                        fmt::format("/nodes/{}", node));
}

void Hide(const GltfVisibility& visibility, Parameters* parameters) {
    const ParameterWriter write(parameters, {});
    if (visibility.hiddenFromCamera) write.Bool("hiddenfromcamera", true);
    if (visibility.castsNoShadow) write.Bool("castsnoshadow", true);
}

}  // namespace lull
