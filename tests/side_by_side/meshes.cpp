#include "tests/side_by_side/meshes.h"

namespace lull {
namespace {

constexpr uint32_t kAround = 64, kAlong = 32;

// Spans a grid of (columns + 1) x (rows + 1) points p(u, v), u and v in [0, 1].
template <typename P>
GltfMesh Grid(uint32_t columns, uint32_t rows, P&& p) {
    GltfMesh mesh;
    for (uint32_t j = 0; j <= rows; ++j)
        for (uint32_t i = 0; i <= columns; ++i) {
            mesh.uvs.emplace_back(float(i) / float(columns), float(j) / float(rows));
            mesh.positions.push_back(p(mesh.uvs.back().x(), mesh.uvs.back().y()));
        }
    for (uint32_t j = 0; j < rows; ++j)
        for (uint32_t i = 0; i < columns; ++i) {
            const uint32_t at = j * (columns + 1) + i, above = at + columns + 1;
            mesh.triangles.push_back({at, at + 1, above + 1});
            mesh.triangles.push_back({at, above + 1, above});
        }
    return mesh;
}

// Other kinds have no triangles: MakeGltfMesh leaves them out.
template <typename S>
GltfMesh Triangulate(const S&) {
    return {};
}

Vec3f Turned(const Vec3f& p, float phi) { return Eigen::AngleAxisf(phi, Vec3f::UnitZ()) * p; }

// Gives vertices without a normal that of their triangles together.
void FillNormals(GltfMesh* mesh) {
    std::vector<Vec3f> sums(mesh->positions.size(), Vec3f::Zero());
    for (const auto& [a, b, c] : mesh->triangles) {
        const Vec3f& p = mesh->positions[a];
        const Vec3f n = (mesh->positions[b] - p).cross(mesh->positions[c] - p);
        for (const uint32_t v : {a, b, c}) sums[v] += n;
    }
    for (size_t i = 0; i < sums.size(); ++i) {
        Vec3f& n = mesh->normals[i];
        if (!(n.norm() > 0)) n = sums[i];
        n = n.norm() > 0 ? n.normalized() : Vec3f(0, 1, 0);
    }
}

GltfMesh Triangulate(const Mesh& m) {
    GltfMesh mesh{m.p, m.n, m.uv, m.triangles};
    mesh.positions.pop_back();  // the accelerator's
    if (!mesh.normals.empty()) FillNormals(&mesh);
    return mesh;
}

GltfMesh Triangulate(const Sphere& s) {
    GltfMesh mesh = Grid(kAround, kAlong, [&](float u, float v) {
        const float theta = (1 - v) * kPi;
        return Turned({s.radius * std::sin(theta), 0, s.radius * std::cos(theta)}, u * s.phiMax);
    });
    for (const Vec3f& p : mesh.positions) mesh.normals.push_back(p.normalized());
    return mesh;
}

GltfMesh Triangulate(const Disk& d) {
    // pbrt's v is 0 at the rim.
    GltfMesh mesh = Grid(kAround, 1, [&](float u, float v) {
        return Turned({Lerp(v, d.radius, d.innerRadius), 0, d.height}, u * d.phiMax);
    });
    mesh.normals.assign(mesh.positions.size(), Vec3f::UnitZ());
    return mesh;
}

GltfMesh Triangulate(const Revolved& r) {
    GltfMesh mesh = Grid(kAround, kAlong, [&](float u, float v) {
        Eigen::Vector3d p = r.start + v * (r.end - r.start);
        if (r.isParabola) {
            const double r2 = r.r2.dot(Eigen::Vector3d(1, p.z(), p.z() * p.z()));
            p.head<2>() = Eigen::Vector2d(std::sqrt(std::max(0., r2)), 0);
        }
        return Turned(p.cast<float>(), u * r.phiMax);
    });
    mesh.normals.assign(mesh.positions.size(), Vec3f::Zero());
    FillNormals(&mesh);
    return mesh;
}

// Turns each triangle to the side of its normals or, where there are none, all or none of them.
void Orient(bool flip, GltfMesh* mesh) {
    for (auto& [a, b, c] : mesh->triangles) {
        if (!mesh->normals.empty()) {
            const Vec3f& p = mesh->positions[a];
            const Vec3f n = (mesh->positions[b] - p).cross(mesh->positions[c] - p);
            flip = n.dot(mesh->normals[a] + mesh->normals[b] + mesh->normals[c]) < 0;
        }
        if (flip) std::swap(b, c);
    }
}

}  // namespace

GltfMesh MakeGltfMesh(const Shape& shape, const Mat4d& m) {
    GltfMesh mesh = std::visit([](const auto& g) { return Triangulate(g); }, shape.geometry);
    Mat4d all = m;
    bool flipNormals = false, flipTriangles = false;
    std::visit(
        [&](const auto& geometry) {
            if constexpr (std::is_same_v<std::decay_t<decltype(geometry)>, Mesh>) {
                // Normals of its own are as they are.
                flipTriangles = geometry.flipNormals != (m.topLeftCorner<3, 3>().determinant() < 0);
            } else if constexpr (requires { geometry.place.worldFromShape; }) {
                all = m * geometry.place.worldFromShape;
                flipNormals = geometry.place.flipNormals;
            }
        },
        shape.geometry);
    const Mat4d inverse = all.inverse();
    for (Vec3f& p : mesh.positions) p = TransformPoint(all, p);
    for (Vec3f& n : mesh.normals)
        n = TransformNormal(inverse, n).normalized() * (flipNormals ? -1.f : 1.f);
    for (Vec2f& uv : mesh.uvs) uv.y() = 1 - uv.y();
    Orient(flipTriangles, &mesh);
    return mesh;
}

}  // namespace lull
