#include "renderer/input/gltf/animations.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "renderer/base/rounding.h"
#include "renderer/files/file_contents.h"
#include "renderer/input/gltf/accessors.h"
#include "renderer/input/gltf/choice.h"

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

// Reads keys of `components` numbers each; 0: any number of scalars.
Keys ReadKeys(const GltfDocument& document, const tinygltf::AnimationSampler& sampler,
              int components) {
    Keys keys{ReadFloats(document, sampler.input, 1, 1).values, {}, 0, sampler.interpolation};
    // Keys that follow each other closely are rounded to the same time.
    for (size_t i = 1; i < keys.times.size(); ++i) {
        if (IsAbove(double(keys.times[i - 1]), double(keys.times[i])))
            throw Error(document.At(fmt::format("/accessors/{}", sampler.input)),
                        fmt::format("key {} is earlier than the one before", i));
        keys.times[i] = std::max(keys.times[i], keys.times[i - 1]);
    }
    const int least = std::max(components, 1);
    keys.values = ReadFloats(document, sampler.output, least, least).values;
    const size_t parts = keys.times.size() * (sampler.interpolation == "CUBICSPLINE" ? 3 : 1);
    keys.width = keys.values.size() / parts;
    if (keys.width == 0 || keys.values.size() % parts != 0 ||
        (components > 0 && keys.width != size_t(components)))
        throw Error(document.At(fmt::format("/accessors/{}", sampler.output)),
                    fmt::format("its {} numbers do not fit {} keys", keys.values.size(),
                                keys.times.size()));
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

// Evaluates an animation sampler (appendix C of the specification).
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

// Returns the numbers of the animations that pose the scene, in their order.
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

// Sets the property of a node that a channel, at `loc`, animates.
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

}  // namespace

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

}  // namespace lull
