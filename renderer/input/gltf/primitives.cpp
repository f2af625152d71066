#include "renderer/input/gltf/primitives.h"

#include <fmt/format.h>
#include <numeric>

#include <cmath>

#include "renderer/input/gltf/accessors.h"
#include "renderer/input/gltf/parameters.h"

namespace lull {
namespace {

// Returns whether integers of an attribute are normalised whatever their accessors say, as others
// are no valid ones (3.7.2.1): some exporters leave the property out.
bool Normalizes(const GltfDocument& document, const std::string& attribute) {
    if (attribute.starts_with("COLOR_")) return true;
    const std::vector<std::string>& used = document.model.extensionsUsed;
    return attribute.starts_with("TEXCOORD_") &&
           std::find(used.begin(), used.end(), "KHR_mesh_quantization") == used.end();
}

// Adds the morph targets of an attribute, each by its weight (3.7.2.2). A tangent's sign, or an
// alpha, that a target lacks stays.
void AddTargets(const GltfDocument& document, const FileLoc& loc,
                const tinygltf::Primitive& primitive, const std::string& name,
                const std::vector<double>& weights, GltfArray* array) {
    if (!weights.empty() && weights.size() != primitive.targets.size())
        throw Error(loc, fmt::format("has {} morph targets for {} weights",
                                     primitive.targets.size(), weights.size()));
    for (size_t i = 0; i < weights.size(); ++i) {
        const auto found = primitive.targets[i].find(name);
        if (weights[i] == 0 || found == primitive.targets[i].end()) continue;
        const GltfArray target = ReadFloats(document, found->second, std::min(array->components, 3),
                                            array->components, Normalizes(document, name));
        if (target.Count() != array->Count())
            throw Error(loc, fmt::format("has {} {} in morph target {} for {} vertices",
                                         target.Count(), name, i, array->Count()));
        for (size_t k = 0; k < target.values.size(); ++k) {
            const auto components = size_t(target.components);
            float& value =
                array->values[k / components * size_t(array->components) + k % components];
            value += float(weights[i]) * target.values[k];
            if (!std::isfinite(value)) throw Error(loc, "its morph weights are too large");
        }
    }
}

// Reads an attribute of `least` to `most` components, one a vertex, and morphs it; nothing where it
// is absent.
GltfArray ReadAttribute(const GltfDocument& document, const FileLoc& loc,
                        const tinygltf::Primitive& primitive, const std::string& name, int least,
                        int most, const std::vector<double>& weights, size_t vertexCount,
                        Warnings& warnings) {
    const auto found = primitive.attributes.find(name);
    if (found == primitive.attributes.end()) return {};
    const bool normalizes = Normalizes(document, name);
    GltfArray array = ReadFloats(document, found->second, least, most, normalizes);
    const tinygltf::Accessor& accessor = document.model.accessors[size_t(found->second)];
    if (normalizes && !accessor.normalized &&
        accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
        warnings.Add(loc, "integers count as normalized, though their accessor does not say so",
                     name);
    if (array.Count() != vertexCount)
        throw Error(loc,
                    fmt::format("has {} {} for {} vertices", array.Count(), name, vertexCount));
    AddTargets(document, loc, primitive, name, weights, &array);
    return array;
}

// Gives colours an alpha.
std::vector<float> WithAlpha(GltfArray colors) {
    if (colors.components == 4) return std::move(colors.values);
    std::vector<float> values;
    values.reserve(colors.Count() * 4);
    for (size_t i = 0; i < colors.Count(); ++i) {
        values.insert(values.end(), &colors.values[3 * i], &colors.values[3 * i] + 3);
        values.push_back(1);
    }
    return values;
}

// Turns strips and fans into triangles (3.7.2.1); the order of their corners tells the front side.
std::vector<uint32_t> Triangles(std::vector<uint32_t> v, int mode) {
    if (mode == TINYGLTF_MODE_TRIANGLES || v.size() < 3) {
        v.resize(v.size() / 3 * 3);
        return v;
    }
    std::vector<uint32_t> triangles;
    triangles.reserve((v.size() - 2) * 3);
    for (size_t i = 0; i + 2 < v.size(); ++i) {
        if (mode == TINYGLTF_MODE_TRIANGLE_FAN)
            triangles.insert(triangles.end(), {v[i + 1], v[i + 2], v[0]});
        else
            triangles.insert(triangles.end(), {v[i], v[i + 1 + i % 2], v[i + 2 - i % 2]});
    }
    return triangles;
}

// Returns whether all tangents have a direction, and one that is not the normal's.
bool AreTangential(const GltfTriangles& t) {
    for (size_t i = 0; 4 * i < t.tangents.size(); ++i) {
        const Eigen::Map<const Vec3f> tangent(&t.tangents[4 * i]), normal(&t.normals[3 * i]);
        if (!(tangent.cross(normal).norm() > 1e-6f * tangent.norm() * normal.norm())) return false;
    }
    return true;
}

std::vector<uint32_t> IndicesOf(const GltfDocument& document, const tinygltf::Primitive& primitive,
                                size_t vertexCount) {
    if (primitive.indices >= 0) return ReadIndices(document, primitive.indices, vertexCount);
    std::vector<uint32_t> all(vertexCount);
    std::iota(all.begin(), all.end(), 0u);
    return all;
}

}  // namespace

GltfTriangles ReadPrimitive(const GltfDocument& document, int mesh, int index,
                            const std::vector<double>& weights, Warnings& warnings) {
    const tinygltf::Primitive& primitive =
        document.model.meshes[size_t(mesh)].primitives[size_t(index)];
    const FileLoc loc = document.At(fmt::format("/meshes/{}/primitives/{}", mesh, index));
    const int mode = primitive.mode < 0 ? TINYGLTF_MODE_TRIANGLES : primitive.mode;
    if (mode < TINYGLTF_MODE_TRIANGLES) {
        warnings.Add(loc, "points and lines are left out");
        return {};
    }
    const auto positions = primitive.attributes.find("POSITION");
    if (positions == primitive.attributes.end()) {
        warnings.Add(loc, "primitive without POSITION is left out");
        return {};
    }

    GltfTriangles t;
    const auto count = size_t(document.model.accessors[size_t(positions->second)].count);
    const auto read = [&](const char* name, int least, int most) {
        return ReadAttribute(document, loc, primitive, name, least, most, weights, count, warnings);
    };
    t.positions = read("POSITION", 3, 3).values;
    t.normals = read("NORMAL", 3, 3).values;
    if (!t.normals.empty()) t.tangents = read("TANGENT", 4, 4).values;
    // Exporters write 0 where they found none; MakeTangents() finds one wherever it is asked to.
    if (!AreTangential(t)) t.tangents.clear();
    t.uvs[0] = read("TEXCOORD_0", 2, 2).values;
    t.uvs[1] = read("TEXCOORD_1", 2, 2).values;
    for (std::vector<float>& uvs : t.uvs)
        for (size_t i = 1; i < uvs.size(); i += 2) uvs[i] = 1 - uvs[i];
    t.colors = WithAlpha(read("COLOR_0", 3, 4));

    std::vector<uint32_t> corners = IndicesOf(document, primitive, count);
    if (mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3 != 0)
        warnings.Add(loc, "the last corners, which make up no triangle, are left out");
    t.indices = Triangles(std::move(corners), mode);
    if (t.indices.empty()) warnings.Add(loc, "primitive without triangles is left out");
    if (t.indices.size() > size_t(std::numeric_limits<int>::max()))
        throw Error(loc, "has more triangles than can be modelled");
    return t;
}

ShapeEntity MakeShapeEntity(GltfTriangles t, const FileLoc& loc) {
    ShapeEntity shape;
    shape.name = "trianglemesh";
    shape.loc = loc;
    const ParameterWriter write(&shape.parameters, loc);
    write.Ints("indices", {t.indices.begin(), t.indices.end()});
    write.Floats(ParameterType::Point3, "P", std::move(t.positions));
    const auto optional = [&](ParameterType type, const char* name, std::vector<float>& values) {
        if (!values.empty()) write.Floats(type, name, std::move(values));
    };
    optional(ParameterType::Normal, "N", t.normals);
    optional(ParameterType::Float, "uv", t.uvs[0]);
    optional(ParameterType::Float, "uv1", t.uvs[1]);
    optional(ParameterType::Float, "tangent", t.tangents);
    optional(ParameterType::Float, "color", t.colors);
    return shape;
}

}  // namespace lull
