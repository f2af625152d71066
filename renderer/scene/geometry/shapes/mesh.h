// Represents triangle meshes, in world space or in the space of their object.
#pragma once

#include <optional>
#include <vector>

#include "renderer/scene/interaction.h"

namespace lull {

// Data for sampling an emitting triangle, in one place.
struct EmittingTriangle {
    Vec3f p0, p1, p2, n;
    float areaPdf;  // 1 / area

    float Area() const { return 1 / areaPdf; }
    Bounds3f WorldBounds() const;
    NormalBounds Normals() const { return {n, 1}; }
};

// Samples uniformly by area, with the barycentric coordinates of SampleUniformTriangle(u).
std::optional<ShapeSample> Sample(const EmittingTriangle&, const Vec3f& from, const Vec2f& u);
ShapeSample SampleArea(const EmittingTriangle&, const Vec2f& u);
inline float Pdf(const EmittingTriangle& triangle, const Vec3f& from, const Vec3f& p,
                 const Vec3f& n) {
    return SolidAnglePdf(triangle.areaPdf, from, p, n);
}

// A triangle's data, in one place: what all hits read lies in two cache lines.
struct alignas(32) TriangleCorners {
    std::array<Vec3f, 3> p, n;  // n: of meshes that have normals; need not be unit
    std::array<Vec2f, 3> uv;
};

struct Mesh {
    // The accelerator's: those of the vertices, and the vertices of each triangle.
    std::vector<Vec3f> p;
    std::vector<std::array<uint32_t, 3>> triangles;
    std::vector<TriangleCorners> corners;  // by triangle
    bool hasNormals = false;
    // Read by some materials only, each empty or one per vertex: the second texture coordinates,
    // colours with alpha, and tangents along u, whose fourth number is the side of the other
    // tangent: (n x tangent) times it.
    std::vector<Vec2f> uv1;
    std::vector<std::array<float, 4>> colors, tangents;
    bool reverseOrientation = false;
    bool flipNormals = false;  // reverseOrientation xor the transform mirrors
    // The order of the vertices tells the front side, as in glTF: vertex normals are turned to it.
    bool frontByWinding = false;

    uint32_t PrimitiveCount() const { return uint32_t(triangles.size()); }
    Bounds3f WorldBounds() const;  // of the triangles

    // Makes `corners` of normals and texture coordinates, each empty or one a vertex.
    void SetCorners(const std::vector<Vec3f>& n, const std::vector<Vec2f>& uv);

    Vec2f Uv(uint32_t triangle, float b1, float b2) const;
    Vec2f Uv1(uint32_t triangle, float b1, float b2) const;  // as Uv where there is no second set
    std::array<float, 4> Color(uint32_t triangle, float b1, float b2) const;  // 1 without colours
    float Area(uint32_t triangle) const;
    // The emitting side is pbrt-v3's, unless `frontByWinding`: vertex normals decide, regardless of
    // ReverseOrientation; a triangle's own are added.
    EmittingTriangle EmitterAt(uint32_t triangle) const;
};

// The ray is not read.
void Interact(const Mesh&, const Ray&, const Hit&, SurfaceNeeds, SurfaceInteraction*);

}  // namespace lull
