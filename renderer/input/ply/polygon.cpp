#include "renderer/input/ply/polygon.h"

#include <algorithm>

namespace lull {
namespace {

using Triangle = std::array<size_t, 3>;
using Point = Eigen::Vector2d;

std::vector<Triangle> FanOf(size_t corners) {
    std::vector<Triangle> triangles;
    for (size_t i = 2; i < corners; ++i) triangles.push_back({0, i - 1, i});
    return triangles;
}

double TwiceArea(const Point& a, const Point& b, const Point& c) {
    return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

// Returns the corners in the polygon's mean plane, where they turn left about it.
std::vector<Point> Flattened(std::span<const uint32_t> vertices, std::span<const Vec3f> positions) {
    const auto at = [&](size_t i) -> Eigen::Vector3d {
        return positions[vertices[i % vertices.size()]].cast<double>();
    };
    Eigen::Vector3d normal = Eigen::Vector3d::Zero();
    for (size_t i = 1; i + 1 < vertices.size(); ++i)
        normal += (at(i) - at(0)).cross(at(i + 1) - at(0));
    int axis;
    normal.cwiseAbs().maxCoeff(&axis);
    const int x = (axis + 1) % 3, y = (axis + 2) % 3;
    std::vector<Point> points;
    for (size_t i = 0; i < vertices.size(); ++i)
        points.push_back(normal[axis] < 0 ? Point(at(i)[y], at(i)[x]) : Point(at(i)[x], at(i)[y]));
    return points;
}

bool IsConvex(const std::vector<Point>& p) {
    const size_t n = p.size();
    for (size_t i = 0; i < n; ++i)
        if (TwiceArea(p[i], p[(i + 1) % n], p[(i + 2) % n]) < 0) return false;
    return true;
}

// Returns whether corner k of those that are left can be cut off.
bool IsEar(const std::vector<Point>& p, const std::vector<size_t>& left, size_t k) {
    const size_t n = left.size(), before = left[(k + n - 1) % n], here = left[k],
                 after = left[(k + 1) % n];
    const Point &a = p[before], &b = p[here], &c = p[after];
    if (!(TwiceArea(a, b, c) > 0)) return false;
    return std::ranges::none_of(left, [&](size_t i) {
        const Point& q = p[i];
        return q != a && q != b && q != c && TwiceArea(a, b, q) >= 0 && TwiceArea(b, c, q) >= 0 &&
               TwiceArea(c, a, q) >= 0;
    });
}

}  // namespace

std::vector<Triangle> TrianglesOf(std::span<const uint32_t> vertices,
                                  std::span<const Vec3f> positions) {
    const std::vector<Triangle> fan = FanOf(vertices.size());
    const auto isThere = [&](uint32_t v) {
        return v < positions.size() && positions[v].allFinite();
    };
    if (vertices.size() == 3 || !std::ranges::all_of(vertices, isThere)) return fan;
    const std::vector<Point> points = Flattened(vertices, positions);
    if (IsConvex(points)) return fan;
    std::vector<Triangle> triangles;
    std::vector<size_t> left(vertices.size());
    for (size_t i = 0; i < left.size(); ++i) left[i] = i;
    while (left.size() > 3) {
        size_t k = 0;
        while (k < left.size() && !IsEar(points, left, k)) ++k;
        if (k == left.size()) return fan;  // it crosses itself, or has no area
        const size_t n = left.size();
        triangles.push_back({left[(k + n - 1) % n], left[k], left[(k + 1) % n]});
        left.erase(left.begin() + long(k));
    }
    triangles.push_back({left[0], left[1], left[2]});
    return triangles;
}

}  // namespace lull
