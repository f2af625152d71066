#include <fmt/format.h>

#include "renderer/base/math.h"
#include "renderer/scene/geometry/shapes/shape_factory.h"

namespace lull {
namespace {

using Eigen::Vector3d;
using Eigen::Vector4d;

constexpr int kMaxSide = 1 << 14;  // of a heightfield or a net: the square still fits an int

void JoinGrid(int nu, int nv, MeshData* data) {
    const auto vertex = [&](int u, int v) { return uint32_t(v * nu + u); };
    for (int v = 0; v + 1 < nv; ++v)
        for (int u = 0; u + 1 < nu; ++u) {
            data->triangles.push_back({vertex(u, v), vertex(u + 1, v), vertex(u + 1, v + 1)});
            data->triangles.push_back({vertex(u, v), vertex(u + 1, v + 1), vertex(u, v + 1)});
        }
}

int ReadCount(const ShapeEntity& entity, const char* name, int least) {
    const int n = entity.parameters.GetInt(name, -1);
    if (n < least || n > kMaxSide)
        throw Error(entity.loc, "\"{}\" of a {} has to be between {} and {}; it is {}", name,
                    entity.name, least, kMaxSide, n);
    return n;
}

struct Spline {
    int count, order;
    std::vector<double> knots;
    double first, last;
};

Spline ReadSpline(const ShapeEntity& entity, const std::string& letter) {
    const Parameters& params = entity.parameters;
    Spline s;
    s.count = ReadCount(entity, ("n" + letter).c_str(), 2);
    s.order = ReadCount(entity, (letter + "order").c_str(), 2);
    const auto knots = params.GetFloats(ParameterType::Float, letter + "knots");
    const auto fail = [&](const std::string& what) { throw Error(entity.loc, what); };
    if (s.order > s.count)
        fail(fmt::format("\"{}order\" is {}, above the number of control points, {}", letter,
                         s.order, s.count));
    if (int(knots.size()) != s.count + s.order)
        fail(fmt::format("\"{}knots\" has {} values; {} control points of order {} need {}", letter,
                         knots.size(), s.count, s.order, s.count + s.order));
    s.knots.assign(knots.begin(), knots.end());
    for (size_t i = 0; i < s.knots.size(); ++i) {
        if (!std::isfinite(s.knots[i]) || (i > 0 && IsAbove(s.knots[i - 1], s.knots[i])))
            fail(fmt::format("\"{}knots\" have to be finite and ascending", letter));
        if (i > 0) s.knots[i] = std::max(s.knots[i], s.knots[i - 1]);
    }
    const double begin = s.knots[s.order - 1], end = s.knots[s.count];
    if (!(begin < end)) fail(fmt::format("\"{}knots\" leave no range to show", letter));
    s.first = params.GetFloat(letter + "0", float(begin));
    s.last = params.GetFloat(letter + "1", float(end));
    for (double* t : {&s.first, &s.last}) {
        const auto within = InRange(*t, begin, end);
        if (!within)
            fail(fmt::format("\"{0}0\" and \"{0}1\" have to lie between the knots {1} and {2}",
                             letter, begin, end));
        *t = *within;
    }
    return s;
}

// Returns the k with knots[k] < t <= knots[k + 1], at the start the first that is not empty.
int SpanOf(const Spline& s, double t) {
    int k = s.order - 1;
    while (k < s.count - 1 && (t > s.knots[k + 1] || s.knots[k] == s.knots[k + 1])) ++k;
    while (k > s.order - 1 && s.knots[k] == s.knots[k + 1]) --k;
    return k;
}

// Evaluates the homogeneous curve of points at(0), ... and its derivative, by de Boor's recursion.
template <typename At>
void Evaluate(const Spline& s, double t, const At& at, Vector4d* value, Vector4d* derivative) {
    const int k = SpanOf(s, t), degree = s.order - 1;
    std::vector<Vector4d> d(s.order);
    for (int j = 0; j <= degree; ++j) d[j] = at(k - degree + j);
    for (int r = 1; r <= degree; ++r) {
        if (r == degree)
            *derivative = degree / (s.knots[k + 1] - s.knots[k]) * (d[degree] - d[degree - 1]);
        for (int j = degree; j >= r; --j) {
            const double low = s.knots[k - degree + j], high = s.knots[j + 1 + k - r];
            const double alpha = (t - low) / (high - low);
            d[j] = (1 - alpha) * d[j - 1] + alpha * d[j];
        }
    }
    *value = d[degree];
}

Vector3d Dehomogenised(const Vector4d& p, const Vector4d& dp) {
    return dp.head<3>() / p.w() - p.head<3>() * (dp.w() / (p.w() * p.w()));
}

std::vector<Vector4d> ReadNet(const ShapeEntity& entity, size_t count) {
    const Parameters& params = entity.parameters;
    const auto points = params.GetFloats(ParameterType::Point3, "P");
    const auto weighted = params.GetFloats(ParameterType::Float, "Pw");
    std::vector<Vector4d> net;
    for (size_t i = 0; i + 2 < points.size(); i += 3)
        net.emplace_back(points[i], points[i + 1], points[i + 2], 1);
    if (net.empty())
        for (size_t i = 0; i + 3 < weighted.size(); i += 4)
            net.emplace_back(weighted[i], weighted[i + 1], weighted[i + 2], weighted[i + 3]);
    if (net.size() != count)
        throw Error(entity.loc,
                    "the nurbs has {} control points in \"P\" or \"Pw\"; \"nu\" times \"nv\" is {}",
                    net.size(), count);
    return net;
}

}  // namespace

MeshData HeightfieldMesh(const ShapeEntity& entity) {
    const int nu = ReadCount(entity, "nu", 2), nv = ReadCount(entity, "nv", 2);
    const auto heights = entity.parameters.GetFloats(ParameterType::Float, "Pz");
    if (heights.size() != size_t(nu) * nv)
        throw Error(entity.loc, "\"Pz\" has {} heights; \"nu\" times \"nv\" is {}", heights.size(),
                    size_t(nu) * nv);
    MeshData data;
    for (int v = 0; v < nv; ++v)
        for (int u = 0; u < nu; ++u) {
            const float z = heights[size_t(v) * nu + u];
            if (!std::isfinite(z)) throw Error(entity.loc, "a height is not finite");
            const Vec2f uv(float(u) / float(nu - 1), float(v) / float(nv - 1));
            data.positions.emplace_back(uv.x(), uv.y(), z);
            data.uvs.push_back(uv);
        }
    JoinGrid(nu, nv, &data);
    return data;
}

MeshData NurbsMesh(const ShapeEntity& entity) {
    const Spline us = ReadSpline(entity, "u"), vs = ReadSpline(entity, "v");
    const std::vector<Vector4d> net = ReadNet(entity, size_t(us.count) * vs.count);
    constexpr int kDice = 30;  // pbrt-v3's
    MeshData data;
    std::vector<Vector4d> rows(vs.count), rowDerivatives(vs.count);
    for (int j = 0; j < kDice; ++j)
        for (int i = 0; i < kDice; ++i) {
            const auto between = [&](const Spline& s, int k) {
                const double x = double(k) / (kDice - 1);
                return (1 - x) * s.first + x * s.last;
            };
            const double u = between(us, i), v = between(vs, j);
            // Evaluate along u those rows of the net that v sees, then along v.
            const int span = SpanOf(vs, v);
            for (int row = span - vs.order + 1; row <= span; ++row)
                Evaluate(
                    us, u, [&](int k) { return net[size_t(row) * us.count + k]; }, &rows[row],
                    &rowDerivatives[row]);
            Vector4d p, pv, pu, mixed;
            Evaluate(
                vs, v, [&](int k) { return rows[k]; }, &p, &pv);
            Evaluate(
                vs, v, [&](int k) { return rowDerivatives[k]; }, &pu, &mixed);
            const Vector3d n = Dehomogenised(p, pu).cross(Dehomogenised(p, pv)).stableNormalized();
            const Vec3f position = p.hnormalized().cast<float>();
            if (!position.allFinite())
                throw Error(entity.loc, "a point of the nurbs is not finite");
            data.positions.push_back(position);
            data.normals.push_back(n.allFinite() ? Vec3f(n.cast<float>()) : Vec3f(Vec3f::Zero()));
            data.uvs.emplace_back(float(u), float(v));
        }
    JoinGrid(kDice, kDice, &data);
    return data;
}

}  // namespace lull
