#include "renderer/scene/slabs.h"

#include <algorithm>
#include <map>
#include <numeric>

#include "renderer/scene/geometry/shapes/mesh.h"

namespace lull {
namespace {

constexpr double kLeastRatio = 20;
// Of the volume that half the area and the thickness make: sides and bevels are area, too.
constexpr double kLeastFilled = 0.75;

using Vec3d = Eigen::Vector3d;
using Triangles = std::vector<std::array<uint32_t, 3>>;

// Sets of numbers that grow together.
class Sets {
  public:
    explicit Sets(size_t count) : parents(count) { std::iota(parents.begin(), parents.end(), 0u); }
    uint32_t Of(uint32_t i) {
        while (parents[i] != i) i = parents[i] = parents[parents[i]];
        return i;
    }
    void Join(uint32_t a, uint32_t b) { parents[Of(a)] = Of(b); }

  private:
    std::vector<uint32_t> parents;
};

// Returns the mesh's triangles with the first vertex at each place.
Triangles Welded(const Mesh& mesh) {
    std::map<std::array<float, 3>, uint32_t> first;
    const auto weld = [&](uint32_t i) {
        const Vec3f& p = mesh.p[i];
        return first.try_emplace({p.x(), p.y(), p.z()}, i).first->second;
    };
    Triangles triangles;
    for (const auto& t : mesh.triangles) triangles.push_back({weld(t[0]), weld(t[1]), weld(t[2])});
    return triangles;
}

bool IsClosed(const Triangles& triangles) {
    std::map<std::pair<uint32_t, uint32_t>, int> edges;
    for (const auto& t : triangles)
        for (int k = 0; k < 3; ++k) {
            const uint32_t a = t[k], b = t[(k + 1) % 3];
            ++edges[std::minmax(a, b)];
        }
    return std::all_of(edges.begin(), edges.end(), [](const auto& e) { return e.second == 2; });
}

bool IsSlab(const Mesh& mesh, const Triangles& part) {
    if (!IsClosed(part)) return false;
    const Vec3d origin = mesh.p[part[0][0]].cast<double>();
    const auto at = [&](uint32_t i) { return Vec3d(mesh.p[i].cast<double>() - origin); };
    Vec3d n = Vec3d::Zero(), along = Vec3d::Zero();
    double area = 0, volume = 0;
    for (const auto& t : part) {
        const Vec3d a = at(t[0]), b = at(t[1]), c = at(t[2]);
        const Vec3d cross = (b - a).cross(c - a);
        if (cross.squaredNorm() > n.squaredNorm()) n = cross;
        area += cross.norm() / 2;
        volume += a.dot(b.cross(c)) / 6;
    }
    if (!(n.norm() > 0)) return false;
    n.normalize();
    // Across the normal, along the longest edge: rectangles are measured along their sides.
    for (const auto& t : part)
        for (int k = 0; k < 3; ++k) {
            Vec3d edge = at(t[(k + 1) % 3]) - at(t[k]);
            edge -= edge.dot(n) * n;
            if (edge.squaredNorm() > along.squaredNorm()) along = edge;
        }
    along.normalize();
    const auto extent = [&](const Vec3d& axis) {
        double least = kInfinity, most = -least;
        for (const auto& t : part)
            for (const uint32_t i : t) {
                least = std::min(least, axis.dot(at(i)));
                most = std::max(most, axis.dot(at(i)));
            }
        return most - least;
    };
    const double thickness = extent(n), across = std::min(extent(along), extent(n.cross(along)));
    return thickness > 0 && across >= kLeastRatio * thickness &&
           std::abs(volume) >= kLeastFilled * thickness * area / 2;
}

}  // namespace

int CountSlabs(const Mesh& mesh) {
    const Triangles all = Welded(mesh);
    Sets sets(mesh.p.size());
    for (const auto& t : all) {
        sets.Join(t[0], t[1]);
        sets.Join(t[1], t[2]);
    }
    std::map<uint32_t, Triangles> parts;
    for (const auto& t : all) parts[sets.Of(t[0])].push_back(t);
    return int(std::count_if(parts.begin(), parts.end(),
                             [&](const auto& part) { return IsSlab(mesh, part.second); }));
}

}  // namespace lull
