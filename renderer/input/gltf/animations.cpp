// Poses nodes by animations, and meshes by skins.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "renderer/base/math.h"
#include "renderer/files/file_io.h"
#include "renderer/input/gltf/accessors.h"
#include "renderer/input/gltf/nodes.h"
#include "renderer/input/gltf/primitives.h"

namespace lull {
namespace {

// The keys of a sampler: `width` values for each time, or, of a cubic spline, the tangent
// before each key, its value, and the tangent after it.
struct Keys {
    std::vector<float> times, values;
    size_t width;
    std::string interpolation;

    Eigen::ArrayXd Value(size_t key, size_t part = 0) const {
        const bool isCubic = interpolation == "CUBICSPLINE";
        const size_t at = (isCubic ? 3 * key + part : key) * width;
        return Eigen::Map<const Eigen::ArrayXf>(&values[at], long(width)).cast<double>();
    }
};

Keys ReadKeys(const GltfDocument& document, const tinygltf::AnimationSampler& sampler,
              int components) {
    Keys keys{ReadFloats(document, sampler.input, 1, 1).values, {}, 0, sampler.interpolation};
    // Keys that follow each other closely are rounded to the same time.
    for (size_t i = 1; i < keys.times.size(); ++i) {
        if (IsAbove(double(keys.times[i - 1]), double(keys.times[i])))
            throw Error(document.At(fmt::format("/accessors/{}", sampler.input)),
                        "key {} is earlier than the one before", i);
        keys.times[i] = std::max(keys.times[i], keys.times[i - 1]);
    }
    const int least = std::max(components, 1);
    keys.values = ReadFloats(document, sampler.output, least, least).values;
    const size_t parts = keys.times.size() * (sampler.interpolation == "CUBICSPLINE" ? 3 : 1);
    keys.width = keys.values.size() / parts;
    if (keys.width == 0 || keys.values.size() % parts != 0 ||
        (components > 0 && keys.width != size_t(components)))
        throw Error(document.At(fmt::format("/accessors/{}", sampler.output)),
                    "its {} numbers do not fit {} keys", keys.values.size(), keys.times.size());
    return keys;
}

// Spherical interpolation along the shorter way (C.4 of the specification).
Eigen::ArrayXd Slerp(const Eigen::ArrayXd& a, const Eigen::ArrayXd& b, double t) {
    const double lengths[] = {a.matrix().norm(), b.matrix().norm()};
    if (!(lengths[0] * lengths[1] > 0)) return t < 0.5 ? a : b;
    const double cosine = (a * b).sum() / (lengths[0] * lengths[1]);
    const Eigen::ArrayXd from = a / lengths[0], to = b / (cosine < 0 ? -lengths[1] : lengths[1]);
    const double angle = std::acos(std::min(std::abs(cosine), 1.));
    if (angle < 1e-6) return (1 - t) * from + t * to;
    return (std::sin((1 - t) * angle) * from + std::sin(t * angle) * to) / std::sin(angle);
}

Eigen::ArrayXd Evaluate(const Keys& keys, double seconds, bool isRotation) {
    const bool isCubic = keys.interpolation == "CUBICSPLINE";
    const size_t value = isCubic ? 1 : 0;
    const auto next = std::upper_bound(keys.times.begin(), keys.times.end(), seconds,
                                       [](double s, float time) { return s < double(time); });
    if (next == keys.times.begin()) return keys.Value(0, value);
    const auto k = size_t(next - keys.times.begin()) - 1;
    if (next == keys.times.end() || keys.interpolation == "STEP") return keys.Value(k, value);
    const double length = double(keys.times[k + 1]) - double(keys.times[k]);
    const double t = (seconds - double(keys.times[k])) / length;
    if (!isCubic) {
        const Eigen::ArrayXd a = keys.Value(k), b = keys.Value(k + 1);
        return isRotation ? Slerp(a, b, t) : Eigen::ArrayXd((1 - t) * a + t * b);
    }
    const double t2 = t * t, t3 = t2 * t;
    return (2 * t3 - 3 * t2 + 1) * keys.Value(k, 1) +
           length * (t3 - 2 * t2 + t) * keys.Value(k, 2) +
           (3 * t2 - 2 * t3) * keys.Value(k + 1, 1) + length * (t3 - t2) * keys.Value(k + 1, 0);
}

std::vector<size_t> Choose(const GltfDocument& document, const std::string& wanted) {
    std::vector<std::string> names;
    for (const tinygltf::Animation& animation : document.model.animations)
        names.push_back(animation.name);
    if (names.empty() && wanted.empty()) throw Error(document.file + ": has no animation to pose");
    if (!wanted.empty()) return {ChooseByName(document, "animation", names, wanted)};
    std::vector<size_t> all(names.size());
    std::iota(all.begin(), all.end(), size_t(0));
    return all;
}

void PoseChannel(double seconds, const tinygltf::Animation& animation,
                 const tinygltf::AnimationChannel& channel, const FileLoc& loc,
                 GltfDocument* document, Warnings& warnings) {
    tinygltf::Node& node = document->model.nodes[size_t(channel.target_node)];
    const std::string& path = channel.target_path;
    const bool isRotation = path == "rotation";
    std::vector<double>* target = nullptr;
    if (path == "translation") target = &node.translation;
    if (isRotation) target = &node.rotation;
    if (path == "scale") target = &node.scale;
    if (path == "weights") target = &node.weights;
    if (!target) return warnings.Add(loc, "animation of \"" + Printable(path) + "\" is left out");
    if (path != "weights" && !node.matrix.empty())
        throw Error(loc, "moves a node that has a matrix, which the specification forbids");
    const tinygltf::AnimationSampler& sampler = animation.samplers[size_t(channel.sampler)];
    const Keys keys = ReadKeys(*document, sampler, path == "weights" ? 0 : isRotation ? 4 : 3);
    const Eigen::ArrayXd value = Evaluate(keys, seconds, isRotation);
    target->assign(value.begin(), value.end());
}

// Gives all nodes that an animation moves the transforms and weights that it has at a time in
// seconds; before its first key and after its last one it stands still. `wanted` is the name or the
// number, from 0, of an animation; empty: all together, with a warning if some move the same, of
// which the first counts. Throws Error if there is none of that name, or for keys that are wrong.
void PoseAt(double seconds, const std::string& wanted, GltfDocument* document, Warnings& warnings) {
    std::map<std::pair<int, std::string>, size_t> posed;  // by which animation
    std::set<size_t> contradicting;
    for (const size_t index : Choose(*document, wanted)) {
        const tinygltf::Animation& animation = document->model.animations[index];
        for (size_t i = 0; i < animation.channels.size(); ++i) {
            const tinygltf::AnimationChannel& channel = animation.channels[i];
            const auto [place, isFirst] =
                posed.insert({{channel.target_node, channel.target_path}, index});
            if (!isFirst && place->second != index) {
                contradicting.insert(index);
                continue;
            }
            const FileLoc loc = document->At(fmt::format("/animations/{}/channels/{}", index, i));
            PoseChannel(seconds, animation, channel, loc, document, warnings);
        }
    }
    if (!contradicting.empty())
        warnings.Add(
            document->At("/animations"),
            fmt::format("{} of {} animations left out in part: others before them move the "
                        "same; --animation NAME|N chooses one",
                        contradicting.size(), document->model.animations.size()));
}

}  // namespace

std::vector<GltfNode> PoseNodes(const GltfOptions& options, GltfDocument* document,
                                Warnings& warnings) {
    if (!options.frame) {
        if (!document->model.animations.empty())
            warnings.Add(document->At("/animations"),
                         "the scene is shown as the file stands; --frame SECONDS poses its "
                         "animation");
        return ListNodes(*document);
    }
    std::vector<GltfNode> later;
    std::vector<std::vector<double>> laterWeights;
    if (options.shutter > 0) {
        Warnings unheard;  // those below are the same
        PoseAt(*options.frame + options.shutter, options.animation, document, unheard);
        later = ListNodes(*document);
        for (const tinygltf::Node& node : document->model.nodes)
            laterWeights.push_back(node.weights);
    }
    PoseAt(*options.frame, options.animation, document, warnings);
    std::vector<GltfNode> nodes = ListNodes(*document);
    // Poses change no hierarchy: both lists are in the same order.
    for (size_t i = 0; i < later.size(); ++i) {
        if (TransformPair{{nodes[i].worldFromNode, later[i].worldFromNode}}.IsAnimated())
            nodes[i].atClose = later[i].worldFromNode;
        const auto index = size_t(nodes[i].index);
        if (document->model.nodes[index].weights != laterWeights[index])
            warnings.Add(document->At(fmt::format("/nodes/{}", index)),
                         "morph targets are not blurred by their motion");
    }
    return nodes;
}

namespace {

struct Influences {
    GltfArray joints, weights;
};

std::vector<Influences> ReadInfluences(const GltfDocument& document, const FileLoc& loc,
                                       const tinygltf::Primitive& primitive,
                                       const GltfTriangles& t) {
    std::vector<Influences> sets;
    const auto read = [&](int accessor) {
        GltfArray array = ReadNumbers(document, accessor, 4, 4);
        if (array.Count() != t.VertexCount())
            throw Error(loc, "its joints or weights are not {}, as its vertices are",
                        t.VertexCount());
        ClearNonFinite(t.indices, &array, [&](uint32_t vertex) {
            throw Error(loc, "vertex {} has joints or weights that are not finite", vertex);
        });
        return array;
    };
    while (true) {
        const auto joints = primitive.attributes.find(fmt::format("JOINTS_{}", sets.size()));
        const auto weights = primitive.attributes.find(fmt::format("WEIGHTS_{}", sets.size()));
        if (joints == primitive.attributes.end() || weights == primitive.attributes.end()) break;
        sets.push_back({read(joints->second), read(weights->second)});
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
        throw Error(loc, "has {} inverse bind matrices for {} joints", inverseBind.size() / 16,
                    skin.joints.size());
    std::vector<const GltfNode*> listed(document.model.nodes.size());
    for (const GltfNode& node : nodes) listed[size_t(node.index)] = &node;
    std::vector<Mat4d> joints;
    for (size_t i = 0; i < skin.joints.size(); ++i) {
        const GltfNode* node = listed[size_t(skin.joints[i])];
        if (!node) throw Error(loc, "its joint {} is not in the scene", i);
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
    const std::vector<Influences> sets = ReadInfluences(document, loc, primitive, *t);
    for (size_t v = 0; v < t->VertexCount(); ++v) {
        Mat4d blended = Mat4d::Zero();
        double sum = 0;
        for (const Influences& set : sets)
            for (size_t k = 4 * v; k < 4 * v + 4; ++k) {
                if (set.weights.values[k] == 0) continue;
                const float joint = set.joints.values[k];
                if (!(joint >= 0 && size_t(joint) < joints.size()))
                    throw Error(loc, "vertex {} has joint {}, but its skin has {}", v, joint,
                                joints.size());
                blended += double(set.weights.values[k]) * joints[size_t(joint)];
                sum += double(set.weights.values[k]);
            }
        blended = sum != 0 ? Mat4d(blended / sum) : joints.at(0);
        const Eigen::Matrix3d linear = blended.topLeftCorner<3, 3>();
        Eigen::Map<Vec3f> p(&t->positions[3 * v]);
        p = (linear * p.cast<double>() + blended.topRightCorner<3, 1>()).cast<float>();
        if (!p.allFinite()) throw Error(loc, "its skin takes vertex {} too far", v);
        if (!t->normals.empty()) Turn(ForNormals(linear), &t->normals[3 * v]);
        if (!t->tangents.empty()) Turn(linear, &t->tangents[4 * v]);
    }
}

}  // namespace lull
