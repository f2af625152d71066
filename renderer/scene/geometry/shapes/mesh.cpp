#include "renderer/scene/geometry/shapes/mesh.h"

#include "renderer/base/sampling.h"

namespace lull {
namespace {

template <typename T, size_t N>
std::array<T, N> Interpolate(const std::vector<std::array<T, N>>& values,
                             const std::array<uint32_t, 3>& v, float b1, float b2) {
    std::array<T, N> sum;
    for (size_t i = 0; i < N; ++i)
        sum[i] = (1 - b1 - b2) * values[v[0]][i] + b1 * values[v[1]][i] + b2 * values[v[2]][i];
    return sum;
}

void UseVertexTangents(const std::array<float, 4>& tangent, SurfaceInteraction* hit) {
    const Vec3f t(tangent[0], tangent[1], tangent[2]);
    const Vec3f s = t - hit->ns * hit->ns.dot(t);
    const float length = s.norm();
    if (!(length > 1e-6f * t.norm())) return;
    hit->dpdu = s / length;
    hit->dpdv = std::copysign(1.f, tangent[3]) * hit->ns.cross(hit->dpdu);
}

// Computes tangents and, where asked for, derivatives of the normal as pbrt-v3's triangles have
// them (its signs included: bump maps show them).
void ComputeTangents(const Mesh& mesh, const TriangleCorners& corners, SurfaceNeeds needs,
                     SurfaceInteraction* hit) {
    const auto& [p, n, uv] = corners;
    const Vec2f duv02 = uv[0] - uv[2], duv12 = uv[1] - uv[2];
    const Vec3f dp02 = p[0] - p[2], dp12 = p[1] - p[2];
    const float determinant = duv02[0] * duv12[1] - duv02[1] * duv12[0];
    const bool degenerate = std::abs(determinant) < 1e-8f;
    if (!degenerate) {
        hit->dpdu = (duv12[1] * dp02 - duv02[1] * dp12) / determinant;
        hit->dpdv = (duv02[0] * dp12 - duv12[0] * dp02) / determinant;
    }
    if (degenerate || hit->dpdu.cross(hit->dpdv).squaredNorm() == 0)
        CoordinateSystem(UnitOf(dp02.cross(dp12)), &hit->dpdu, &hit->dpdv);
    hit->dndu = hit->dndv = Vec3f::Zero();
    hit->surfaceDpdu = hit->dpdu;
    hit->surfaceDpdv = hit->dpdv;
    if (!mesh.hasNormals) return;

    // Make an orthonormal shading frame out of dpdu and the interpolated normal.
    Vec3f s = hit->dpdu.normalized();
    Vec3f t = s.cross(hit->ns);
    if (const float length2 = t.squaredNorm(); length2 > 0) {
        t /= std::sqrt(length2);
        s = t.cross(hit->ns);
    } else {
        CoordinateSystem(hit->ns, &s, &t);
    }
    if (needs & kNeedsNormalDerivatives) {
        const Vec3f dn02 = n[0] - n[2], dn12 = n[1] - n[2];
        if (!degenerate) {
            hit->dndu = (duv12[1] * dn02 - duv02[1] * dn12) / determinant;
            hit->dndv = (duv02[0] * dn12 - duv12[0] * dn02) / determinant;
        }
    }
    hit->dpdu = s;
    hit->dpdv = mesh.reverseOrientation ? Vec3f(-t) : t;
}

// Returns the weights of a point that is as far from the triangle's edges as its coordinates can be
// wrong by, and no more than eight times as far from the one given. A point on an edge could
// otherwise come to lie in the plane of the triangle beyond that edge, or behind it, and rays that
// start there would leave a closed mesh. Slivers, less than a quarter as high as long, get a part
// of that distance.
Eigen::Array3f KeepInside(Eigen::Array3f b, const Vec3f& p0, const Vec3f& p1, const Vec3f& p2,
                          const Vec3f& error) {
    constexpr float kLargest = 1.f / 64;  // weight that is looked at, and that is given
    if (b.minCoeff() >= kLargest) return b;
    const float length2 =
        std::max({(p1 - p0).squaredNorm(), (p2 - p1).squaredNorm(), (p0 - p2).squaredNorm()});
    const float least = std::min(kLargest, 4 * error.maxCoeff() / std::sqrt(length2));
    if (b.minCoeff() >= least) return b;
    b = b.max(least);
    return b / b.sum();
}

}  // namespace

Bounds3f EmittingTriangle::WorldBounds() const {
    Bounds3f bounds;
    for (const Vec3f& p : {p0, p1, p2}) bounds.Extend(p);
    return bounds;
}

Bounds3f Mesh::WorldBounds() const {
    Bounds3f bounds;
    for (const auto& triangle : triangles)
        for (const uint32_t v : triangle) bounds.Extend(p[v]);
    return bounds;
}

void Interact(const Mesh& mesh, const Ray&, const Hit& found, SurfaceNeeds needs,
              SurfaceInteraction* hit) {
    const TriangleCorners& corners = mesh.corners[found.primitive];
    const auto& [p0, p1, p2] = corners.p;
    const float b1 = found.b1, b2 = found.b2, b0 = 1 - b1 - b2;
    // The sum of the weighted vertices would bound the error of the point itself, but that of
    // Embree's distance to this triangle comes from all of the vertices, also from a far one that
    // has no weight here.
    hit->pError = Gamma(7) * p0.cwiseAbs().cwiseMax(p1.cwiseAbs()).cwiseMax(p2.cwiseAbs());
    const Eigen::Array3f inside = KeepInside({b0, b1, b2}, p0, p1, p2, hit->pError);
    hit->p = inside[0] * p0 + inside[1] * p1 + inside[2] * p2;
    hit->n = UnitOf((p0 - p2).cross(p1 - p2));
    if (mesh.flipNormals) hit->n = -hit->n;
    hit->ns = hit->n;
    if (mesh.hasNormals) {
        // The interpolated normal decides the side of the geometric one.
        const Vec3f sum = b0 * corners.n[0] + b1 * corners.n[1] + b2 * corners.n[2];
        if (const float length2 = sum.squaredNorm(); length2 > 0)
            hit->ns = sum / std::sqrt(length2);
    }
    if (needs & kNeedsUv) hit->uv = b0 * corners.uv[0] + b1 * corners.uv[1] + b2 * corners.uv[2];
    if (needs & (kNeedsTangents | kNeedsNormalDerivatives | kNeedsFootprint)) {
        ComputeTangents(mesh, corners, needs, hit);
        if (!mesh.tangents.empty())
            UseVertexTangents(Interpolate(mesh.tangents, mesh.triangles[found.primitive], b1, b2),
                              hit);
    }
    if (needs & (kNeedsSecondUv | kNeedsColor)) {
        hit->uv1 = mesh.Uv1(found.primitive, b1, b2);
        const auto c = mesh.Color(found.primitive, b1, b2);
        hit->color = Rgb(c[0], c[1], c[2]);
    }
    if (mesh.hasNormals) {
        if (mesh.reverseOrientation) hit->ns = -hit->ns;
        if (mesh.frontByWinding)
            hit->ns = FaceForward(hit->ns, hit->n);
        else
            hit->n = FaceForward(hit->n, hit->ns);
    }
}

// Meshes without texture coordinates have pbrt-v3's: (0,0), (1,0), (1,1).
void Mesh::SetCorners(const std::vector<Vec3f>& n, const std::vector<Vec2f>& uv) {
    hasNormals = !n.empty();
    corners.reserve(triangles.size());
    for (const auto& v : triangles) {
        TriangleCorners& c = corners.emplace_back();
        c.uv = {Vec2f(0, 0), Vec2f(1, 0), Vec2f(1, 1)};
        for (size_t i = 0; i < 3; ++i) {
            c.p[i] = p[v[i]];
            c.n[i] = hasNormals ? n[v[i]] : Vec3f(Vec3f::Zero());
            if (!uv.empty()) c.uv[i] = uv[v[i]];
        }
    }
}

Vec2f Mesh::Uv(uint32_t triangle, float b1, float b2) const {
    const auto& uv = corners[triangle].uv;
    return (1 - b1 - b2) * uv[0] + b1 * uv[1] + b2 * uv[2];
}

Vec2f Mesh::Uv1(uint32_t triangle, float b1, float b2) const {
    if (uv1.empty()) return Uv(triangle, b1, b2);
    const auto& v = triangles[triangle];
    return (1 - b1 - b2) * uv1[v[0]] + b1 * uv1[v[1]] + b2 * uv1[v[2]];
}

std::array<float, 4> Mesh::Color(uint32_t triangle, float b1, float b2) const {
    if (colors.empty()) return {1, 1, 1, 1};
    return Interpolate(colors, triangles[triangle], b1, b2);
}

float Mesh::Area(uint32_t triangle) const {
    const auto& v = triangles[triangle];
    return 0.5f * LengthOf((p[v[1]] - p[v[0]]).cross(p[v[2]] - p[v[0]]));
}

EmittingTriangle Mesh::EmitterAt(uint32_t triangle) const {
    const auto& [p, n, uv] = corners[triangle];
    const Vec3f cross = (p[1] - p[0]).cross(p[2] - p[0]);
    const float twiceArea = LengthOf(cross);
    Vec3f normal = cross / twiceArea;
    if (hasNormals && !frontByWinding)
        normal = FaceForward(normal, n[0] + n[1] + n[2]);
    else if (flipNormals)
        normal = -normal;
    return {p[0], p[1], p[2], normal, 2 / twiceArea};
}

ShapeSample SampleArea(const EmittingTriangle& triangle, const Vec2f& u) {
    const Vec2f b = SampleUniformTriangle(u);
    const Vec3f q0 = b.x() * triangle.p0, q1 = b.y() * triangle.p1,
                q2 = (1 - b.x() - b.y()) * triangle.p2;
    ShapeSample sample;
    sample.p = q0 + q1 + q2;
    sample.pError = Gamma(6) * (q0.cwiseAbs() + q1.cwiseAbs() + q2.cwiseAbs());
    sample.n = triangle.n;
    sample.pdf = triangle.areaPdf;
    return sample;
}

std::optional<ShapeSample> Sample(const EmittingTriangle& triangle, const Vec3f& from,
                                  const Vec2f& u) {
    return SeenFrom(from, SampleArea(triangle, u));
}

}  // namespace lull
