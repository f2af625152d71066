#include <array>
#include <unordered_map>

#include "renderer/input/gltf/primitives.h"

namespace lull {
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

// Copies vertex `from` to the end of all arrays.
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

// Sums up the tangents of the triangles around each corner. `mirrored` tells the side of each
// triangle.
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

// Gives each vertex the side of the first triangle that has it, and a copy to the others. Returns
// the sides.
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
