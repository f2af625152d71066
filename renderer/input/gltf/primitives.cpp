#include "renderer/input/gltf/primitives.h"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <unordered_map>

#include "renderer/input/gltf/accessors.h"
#include "renderer/input/gltf/materials.h"

namespace lull {
namespace {

// Adds morph targets of an attribute by weight (3.7.2.2). Signs and alphas that they lack stay.
void AddTargets(const GltfDocument& document, const FileLoc& loc,
                const tinygltf::Primitive& primitive, const std::string& name,
                const std::vector<double>& weights, GltfArray* array) {
    if (!weights.empty() && weights.size() != primitive.targets.size())
        throw Error(loc, "has {} morph targets for {} weights", primitive.targets.size(),
                    weights.size());
    for (size_t i = 0; i < weights.size(); ++i) {
        const auto found = primitive.targets[i].find(name);
        if (weights[i] == 0 || found == primitive.targets[i].end()) continue;
        const GltfArray target =
            ReadNumbers(document, found->second, std::min(array->components, 3), array->components,
                        Normalizes(document.model, name));
        if (target.Count() != array->Count())
            throw Error(loc, "has {} {} in morph target {} for {} vertices", target.Count(), name,
                        i, array->Count());
        for (size_t k = 0; k < target.values.size(); ++k) {
            const auto components = size_t(target.components);
            float& value =
                array->values[k / components * size_t(array->components) + k % components];
            value += float(weights[i]) * target.values[k];
        }
    }
}

// Reads an attribute of `least` to `most` components a vertex, and morphs it; nothing where absent.
GltfArray ReadAttribute(const GltfDocument& document, const FileLoc& loc,
                        const tinygltf::Primitive& primitive, const std::string& name, int least,
                        int most, const std::vector<double>& weights, size_t vertexCount,
                        Warnings& warnings) {
    const auto found = primitive.attributes.find(name);
    if (found == primitive.attributes.end()) return {};
    const bool normalizes = Normalizes(document.model, name);
    GltfArray array = ReadNumbers(document, found->second, least, most, normalizes);
    const tinygltf::Accessor& accessor = document.model.accessors[size_t(found->second)];
    if (normalizes && !accessor.normalized &&
        accessor.componentType != TINYGLTF_COMPONENT_TYPE_FLOAT)
        warnings.Add(loc, "integers count as normalized, though their accessor does not say so",
                     name);
    if (array.Count() != vertexCount)
        throw Error(loc, "has {} {} for {} vertices", array.Count(), name, vertexCount);
    AddTargets(document, loc, primitive, name, weights, &array);
    return array;
}

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

void ClearNonFinite(const std::vector<uint32_t>& indices, GltfArray* array,
                    const std::function<void(uint32_t vertex)>& report) {
    const auto isFinite = [](float v) { return std::isfinite(v); };
    if (indices.empty() || std::ranges::all_of(array->values, isFinite)) return;
    const auto at = [&](size_t vertex) {
        const auto n = size_t(array->components);
        return std::span(array->values).subspan(vertex * n, n);
    };
    for (const uint32_t vertex : indices) {
        if (std::ranges::all_of(at(vertex), isFinite)) continue;
        report(vertex);
        std::ranges::fill(at(vertex), 0.f);
    }
    for (size_t vertex = 0; vertex < array->Count(); ++vertex)
        if (!std::ranges::all_of(at(vertex), isFinite))
            std::ranges::copy(at(indices[0]), at(vertex).begin());
}

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
    std::vector<uint32_t> corners = IndicesOf(document, primitive, count);
    if (mode == TINYGLTF_MODE_TRIANGLES && corners.size() % 3 != 0)
        warnings.Add(loc, "the last corners, which make up no triangle, are left out");
    t.indices = Triangles(std::move(corners), mode);
    if (t.indices.empty()) warnings.Add(loc, "primitive without triangles is left out");
    if (t.indices.size() > size_t(std::numeric_limits<int>::max()))
        throw Error(loc, "has more triangles than can be modelled");

    const auto read = [&](const std::string& name, int least, int most) {
        GltfArray array =
            ReadAttribute(document, loc, primitive, name, least, most, weights, count, warnings);
        ClearNonFinite(t.indices, &array, [&](uint32_t vertex) {
            if (name == "POSITION") throw Error(loc, "vertex {} is not finite", vertex);
            warnings.Add(loc, "value of a vertex that is not finite counts as 0", name);
        });
        return array;
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

namespace {

Vec3f VectorAt(const std::vector<float>& values, uint32_t i) {
    return {values[3 * size_t(i)], values[3 * size_t(i) + 1], values[3 * size_t(i) + 2]};
}

// Identifies vertices by the inputs of MikkTSpace, and by the side of the texture.
struct Corner {
    std::array<uint32_t, 8> bits;  // position, normal, texture coordinates
    bool isMirrored;

    bool operator==(const Corner&) const = default;
};

struct HashCorner {
    size_t operator()(const Corner& corner) const {
        uint64_t hash = corner.isMirrored;
        for (const uint32_t b : corner.bits)
            hash = (hash ^ b) * 0x9e3779b97f4a7c15ull ^ (hash >> 29);
        return hash;
    }
};

Corner CornerOf(const GltfTriangles& t, int uvSet, uint32_t vertex, bool isMirrored) {
    Corner corner{{}, isMirrored};
    for (size_t i = 0; i < 3; ++i) {
        corner.bits[i] = std::bit_cast<uint32_t>(t.positions[3 * size_t(vertex) + i]);
        corner.bits[3 + i] = std::bit_cast<uint32_t>(t.normals[3 * size_t(vertex) + i]);
    }
    for (size_t i = 0; i < 2; ++i)
        corner.bits[6 + i] = std::bit_cast<uint32_t>(t.uvs[uvSet][2 * size_t(vertex) + i]);
    return corner;
}

// Returns the unnormalised direction in which u grows over a triangle and the side of its texture.
Vec3f AlongU(const GltfTriangles& t, int uvSet, const uint32_t* v, bool* isMirrored) {
    const auto uv = [&](int i) {
        const float* at = &t.uvs[uvSet][2 * size_t(v[i])];
        return Vec2f(at[0], at[1]);
    };
    const Vec2f a = uv(1) - uv(0), b = uv(2) - uv(0);
    const float area = a.x() * b.y() - a.y() * b.x();
    *isMirrored = area < 0;
    const Vec3f p = VectorAt(t.positions, v[0]);
    const Vec3f along =
        b.y() * (VectorAt(t.positions, v[1]) - p) - a.y() * (VectorAt(t.positions, v[2]) - p);
    return area < 0 ? Vec3f(-along) : along;
}

Vec3f Unit(const Vec3f& v) {
    const float length = v.norm();
    return length > 0 && length < kInfinity ? Vec3f(v / length) : Vec3f(Vec3f::Zero());
}

Vec3f Tangential(const Vec3f& v, const Vec3f& n) { return Unit(v - n * n.dot(v)); }

uint32_t CopyVertex(uint32_t from, GltfTriangles* t) {
    const auto copy = [&](std::vector<float>* values, size_t components) {
        if (values->empty()) return;
        for (size_t i = 0; i < components; ++i)
            values->push_back((*values)[size_t(from) * components + i]);
    };
    const auto index = uint32_t(t->VertexCount());
    copy(&t->positions, 3);
    copy(&t->normals, 3);
    copy(&t->uvs[0], 2);
    copy(&t->uvs[1], 2);
    copy(&t->colors, 4);
    return index;
}

using TangentSums = std::unordered_map<Corner, Vec3f, HashCorner>;

// Sums up the tangents of the triangles around each corner. `mirrored` tells the triangles' sides.
TangentSums SumTangents(const GltfTriangles& t, int uvSet, std::vector<bool>* mirrored) {
    TangentSums sums;
    for (size_t i = 0; i < mirrored->size(); ++i) {
        const uint32_t* v = &t.indices[3 * i];
        bool isMirrored;
        const Vec3f along = AlongU(t, uvSet, v, &isMirrored);
        (*mirrored)[i] = isMirrored;
        for (int k = 0; k < 3; ++k) {
            const Vec3f n = Unit(VectorAt(t.normals, v[k])), p = VectorAt(t.positions, v[k]);
            const Vec3f e1 = Tangential(VectorAt(t.positions, v[(k + 1) % 3]) - p, n);
            const Vec3f e2 = Tangential(VectorAt(t.positions, v[(k + 2) % 3]) - p, n);
            const float angle = std::acos(std::clamp(e1.dot(e2), -1.f, 1.f));
            const auto [sum, isNew] =
                sums.try_emplace(CornerOf(t, uvSet, v[k], isMirrored), Vec3f::Zero());
            sum->second += angle * Tangential(along, n);
        }
    }
    return sums;
}

// Gives each vertex the side of its first triangle, and a copy to the others. Returns the sides.
std::vector<bool> SplitSides(const std::vector<bool>& mirrored, GltfTriangles* t) {
    constexpr uint32_t kNone = ~0u;
    std::vector<std::array<uint32_t, 2>> copies(t->VertexCount(), {kNone, kNone});
    std::vector<bool> side(t->VertexCount());
    for (size_t i = 0; i < t->indices.size(); ++i) {
        const bool isMirrored = mirrored[i / 3];
        std::array<uint32_t, 2>& both = copies[t->indices[i]];
        uint32_t& mine = both[isMirrored];
        if (mine == kNone) {
            mine = both[!isMirrored] == kNone ? t->indices[i] : CopyVertex(t->indices[i], t);
            side.resize(t->VertexCount());
            side[mine] = isMirrored;
        }
        t->indices[i] = mine;
    }
    return side;
}

}  // namespace

void MakeTangents(int uvSet, GltfTriangles* t) {
    if (t->normals.empty() || t->uvs[uvSet].empty()) return;
    std::vector<bool> mirrored(t->indices.size() / 3);
    const TangentSums sums = SumTangents(*t, uvSet, &mirrored);
    const std::vector<bool> side = SplitSides(mirrored, t);
    t->tangents.resize(4 * t->VertexCount());
    for (uint32_t i = 0; i < t->VertexCount(); ++i) {
        const auto found = sums.find(CornerOf(*t, uvSet, i, side[i]));
        Vec3f tangent = found == sums.end() ? Vec3f(Vec3f::Zero()) : Unit(found->second);
        if (tangent.squaredNorm() == 0) {
            Vec3f other;
            const Vec3f n = Unit(VectorAt(t->normals, i));
            CoordinateSystem(n.squaredNorm() > 0 ? n : Vec3f(Vec3f::UnitZ()), &tangent, &other);
        }
        for (int c = 0; c < 3; ++c) t->tangents[4 * size_t(i) + size_t(c)] = tangent[c];
        t->tangents[4 * size_t(i) + 3] = side[i] ? -1.f : 1.f;
    }
}

}  // namespace lull
