#include "renderer/input/loop_subdivision.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace lull {
namespace {

constexpr double kMostTriangles = 50e6;

// A mesh as half-edges. Half-edge 3f + j of face f runs from its vertex j to vertex j + 1;
// its twin runs back along the same edge in the neighbouring face.
struct HalfEdgeMesh {
    std::vector<Vec3f> p;
    std::vector<int> origin;   // vertex where each half-edge begins
    std::vector<int> twin;     // -1 at the boundary
    std::vector<int> leaving;  // a half-edge from each vertex, -1 for none

    int Edges() const { return int(origin.size()); }
    int Target(int h) const { return origin[Next(h)]; }
    static int Next(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
    static int Previous(int h) { return h % 3 == 0 ? h + 2 : h - 1; }
};

void FindTwins(HalfEdgeMesh* mesh, const FileLoc& loc) {
    struct Key {
        int low, high, edge;
        auto operator<=>(const Key&) const = default;
    };
    std::vector<Key> keys;
    keys.reserve(mesh->origin.size());
    for (int h = 0; h < mesh->Edges(); ++h) {
        const auto [low, high] = std::minmax({mesh->origin[h], mesh->Target(h)});
        keys.push_back({low, high, h});
    }
    std::ranges::sort(keys);
    mesh->twin.assign(keys.size(), -1);
    for (size_t i = 0; i < keys.size();) {
        size_t end = i + 1;
        while (end < keys.size() && keys[end].low == keys[i].low && keys[end].high == keys[i].high)
            ++end;
        const auto fail = [&](const char* what) {
            throw Error(loc, "loopsubdiv: the edge between vertices {} and {}{}", keys[i].low,
                        keys[i].high, what);
        };
        if (end - i > 2) fail(" belongs to more than two faces");
        if (end - i == 2) {
            const int a = keys[i].edge, b = keys[i + 1].edge;
            if (mesh->origin[a] == mesh->origin[b]) fail(" runs the same way in both its faces");
            mesh->twin[a] = b;
            mesh->twin[b] = a;
        }
        i = end;
    }
}

HalfEdgeMesh MakeMesh(std::span<const float> p, std::span<const int> indices, const FileLoc& loc) {
    if (p.size() % 3 != 0 || indices.size() % 3 != 0 || indices.empty())
        throw Error(loc, "loopsubdiv needs vertex positions and indices, both in threes, but has " +
                             std::to_string(p.size()) + " and " + std::to_string(indices.size()) +
                             " numbers");
    HalfEdgeMesh mesh;
    for (size_t i = 0; i < p.size(); i += 3) mesh.p.emplace_back(p[i], p[i + 1], p[i + 2]);
    mesh.leaving.assign(mesh.p.size(), -1);
    mesh.origin.assign(indices.begin(), indices.end());
    for (int h = 0; h < mesh.Edges(); ++h) {
        const int v = mesh.origin[h];
        if (v < 0 || size_t(v) >= mesh.p.size())
            throw Error(loc, "loopsubdiv: index {} is out of range, there are {} vertices", v,
                        mesh.p.size());
        if (v == mesh.Target(h))
            throw Error(loc, "loopsubdiv: face {} repeats vertex {}", h / 3, v);
        mesh.leaving[v] = h;
    }
    FindTwins(&mesh, loc);
    return mesh;
}

// Lists the neighbours of vertex v, each once, turning against the direction of the faces; those
// of a boundary vertex from one end of the boundary to the other. Returns whether v is on it.
bool OneRing(const HalfEdgeMesh& mesh, int v, std::vector<Vec3f>* ring) {
    using M = HalfEdgeMesh;
    ring->clear();
    const int start = mesh.leaving[v];
    // Turn until back at the start, or at the boundary, where the ring begins then.
    int h = start;
    do {
        ring->push_back(mesh.p[mesh.Target(h)]);
        if (mesh.twin[h] < 0) break;
        h = M::Next(mesh.twin[h]);
    } while (h != start);
    if (h == start && mesh.twin[h] >= 0) return false;
    ring->clear();
    ring->push_back(mesh.p[mesh.Target(h)]);
    while (h >= 0) {
        const int incoming = M::Previous(h);
        ring->push_back(mesh.p[mesh.origin[incoming]]);
        h = mesh.twin[incoming];
    }
    return true;
}

// Weighs v and its ring: inside, each neighbour by `weight`; on the boundary, the two neighbours
// along it by `boundaryWeight`.
template <typename Weight>
Vec3f Weigh(const HalfEdgeMesh& mesh, int v, const Weight& weight, float boundaryWeight,
            std::vector<Vec3f>* ring) {
    if (mesh.leaving[v] < 0) return mesh.p[v];
    if (OneRing(mesh, v, ring))
        return (1 - 2 * boundaryWeight) * mesh.p[v] +
               boundaryWeight * (ring->front() + ring->back());
    const float w = weight(int(ring->size()));
    Vec3f sum = (1 - w * ring->size()) * mesh.p[v];
    for (const Vec3f& q : *ring) sum += w * q;
    return sum;
}

// Returns Warren's weight of a neighbour (Warren 1995): 3/16 at valence 3, else 3/(8 n).
float Beta(int valence) { return valence == 3 ? 3.f / 16 : 3.f / (8 * valence); }
// Returns the weight of a neighbour in the limit of repeated subdivision (Hoppe et al. 1994).
float LimitWeight(int valence) { return 1 / (valence + 3 / (8 * Beta(valence))); }

std::vector<int> AddMiddles(const HalfEdgeMesh& old, std::vector<Vec3f>* p) {
    std::vector<int> middle(old.origin.size());
    for (int h = 0; h < old.Edges(); ++h) {
        const int twin = old.twin[h];
        if (twin >= 0 && twin < h) {
            middle[h] = middle[twin];
            continue;
        }
        middle[h] = int(p->size());
        const Vec3f ends = old.p[old.origin[h]] + old.p[old.Target(h)];
        if (twin < 0)
            p->push_back(0.5f * ends);
        else
            p->push_back(3.f / 8 * ends + 1.f / 8 *
                                              (old.p[old.origin[HalfEdgeMesh::Previous(h)]] +
                                               old.p[old.origin[HalfEdgeMesh::Previous(twin)]]));
    }
    return middle;
}

// Splits every face 012 in 4: the corners 0 a c, a 1 b, c b 2 and the middle a b c, where a, b, c
// are new vertices on the edges 01, 12, 20. Faces keep their direction.
HalfEdgeMesh Subdivide(const HalfEdgeMesh& old) {
    using M = HalfEdgeMesh;
    HalfEdgeMesh mesh;
    std::vector<Vec3f> ring;
    mesh.p.reserve(old.p.size() + old.origin.size());
    for (size_t v = 0; v < old.p.size(); ++v)
        mesh.p.push_back(Weigh(old, int(v), Beta, 1.f / 8, &ring));

    const std::vector<int> middle = AddMiddles(old, &mesh.p);
    mesh.origin.resize(4 * old.origin.size());
    mesh.twin.resize(mesh.origin.size());
    mesh.leaving.assign(mesh.p.size(), -1);
    // Half-edge h from vertex j of a face falls in two: the first half is edge j of corner j, the
    // second is edge j of corner j + 1. The middle face is child 3.
    const auto child = [](int h, int corner, int edge) {
        return 3 * (4 * (h / 3) + corner) + edge;
    };
    for (int h = 0; h < old.Edges(); ++h) {
        const int j = h % 3, next = (j + 1) % 3, previous = (j + 2) % 3;
        const int first = child(h, j, j), second = child(h, next, j), inner = child(h, 3, j);
        const int across = child(h, next, previous);  // of corner j + 1, along the middle face
        mesh.origin[first] = old.origin[h];
        mesh.origin[second] = mesh.origin[inner] = middle[h];
        mesh.origin[across] = middle[M::Next(h)];
        mesh.twin[inner] = across;
        mesh.twin[across] = inner;
        const int twin = old.twin[h];
        mesh.twin[first] = twin < 0 ? -1 : child(twin, (twin % 3 + 1) % 3, twin % 3);
        mesh.twin[second] = twin < 0 ? -1 : child(twin, twin % 3, twin % 3);
        mesh.leaving[middle[h]] = inner;
    }
    for (size_t v = 0; v < old.p.size(); ++v)
        if (const int h = old.leaving[v]; h >= 0) mesh.leaving[v] = child(h, h % 3, h % 3);
    return mesh;
}

// Returns the product of the limit tangents (Hoppe et al. 1994; masks as in pbrt 3rd ed., 3.8.4),
// from the ring's places on the limit surface as pbrt-v3 takes them.
Vec3f LimitNormal(const HalfEdgeMesh& mesh, int v, std::vector<Vec3f>* scratch) {
    if (mesh.leaving[v] < 0) return Vec3f::Zero();
    const bool isBoundary = OneRing(mesh, v, scratch);
    const std::vector<Vec3f>& ring = *scratch;
    const int n = int(ring.size());
    Vec3f s = Vec3f::Zero(), t = Vec3f::Zero();
    if (!isBoundary) {
        for (int i = 0; i < n; ++i) {
            s += std::cos(2 * kPi * i / n) * ring[i];
            t += std::sin(2 * kPi * i / n) * ring[i];
        }
        return s.cross(t);
    }
    s = ring.back() - ring.front();
    if (n == 2) {
        t = ring[0] + ring[1] - 2 * mesh.p[v];
    } else if (n == 3) {
        t = ring[1] - mesh.p[v];
    } else if (n == 4) {
        t = -ring[0] + 2 * ring[1] + 2 * ring[2] - ring[3] - 2 * mesh.p[v];
    } else {
        const float theta = kPi / (n - 1);
        t = -std::sin(theta) * (ring.front() + ring.back());
        for (int i = 1; i < n - 1; ++i)
            t -= (2 * std::cos(theta) - 2) * std::sin(i * theta) * ring[i];
    }
    return s.cross(t);
}

}  // namespace

MeshData LoopSubdivide(std::span<const float> p, std::span<const int> indices, int levels,
                       const FileLoc& loc) {
    if (std::ldexp(double(indices.size() / 3), 2 * std::clamp(levels, 0, 100)) > kMostTriangles)
        throw Error(loc, "loopsubdiv: " + std::to_string(levels) +
                             " levels make more than 50 million triangles; take fewer");
    HalfEdgeMesh mesh = MakeMesh(p, indices, loc);
    for (int level = 0; level < levels; ++level) mesh = Subdivide(mesh);

    MeshData result;
    std::vector<Vec3f> ring;
    for (size_t v = 0; v < mesh.p.size(); ++v)
        result.positions.push_back(Weigh(mesh, int(v), LimitWeight, 1.f / 5, &ring));
    for (const Vec3f& position : result.positions)
        if (!position.allFinite())
            throw Error(loc, "loopsubdiv: the vertex positions are too large");
    mesh.p = result.positions;
    for (size_t v = 0; v < mesh.p.size(); ++v)
        result.normals.push_back(LimitNormal(mesh, int(v), &ring));
    for (int h = 0; h < mesh.Edges(); h += 3)
        result.triangles.push_back(
            {uint32_t(mesh.origin[h]), uint32_t(mesh.origin[h + 1]), uint32_t(mesh.origin[h + 2])});
    return result;
}

}  // namespace lull
