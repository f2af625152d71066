// Represents triangle meshes, in world space or in the space of their object.
#pragma once

#include <optional>
#include <vector>

#include "renderer/scene/geometry/shapes/shape_sample.h"
#include "renderer/scene/interaction.h"

namespace lull {

// Holds what sampling an emitting triangle reads, in one place.
struct TriangleSampler {
    Vec3f p0, p1, p2, n;
    float areaPdf;  // 1 / area

    // Samples uniformly by area. Returns nothing for a degenerate configuration.
    std::optional<ShapeSample> Sample(const Vec3f& from, const Vec2f& u) const;
};

struct Mesh {
    std::vector<Vec3f> p;
    std::vector<Vec3f> n;   // empty or one a vertex; need not be unit
    std::vector<Vec2f> uv;  // empty or one a vertex
    // What only some materials read, each empty or one per vertex: the second texture coordinates,
    // colours with alpha, and tangents along u, whose fourth number is the side of the other
    // tangent: (n x tangent) times it.
    std::vector<Vec2f> uv1;
    std::vector<std::array<float, 4>> colors, tangents;
    std::vector<std::array<uint32_t, 3>> triangles;
    bool reverseOrientation = false;
    bool flipNormals = false;  // reverseOrientation xor the transform mirrors

    // Fills in everything about the hit except wo, material and light; b1 and b2 are the weights of
    // the second and third vertex.
    void Interact(uint32_t triangle, float b1, float b2, SurfaceNeeds needs,
                  SurfaceInteraction* hit) const;

    Vec2f Uv(uint32_t triangle, float b1, float b2) const;
    Vec2f Uv1(uint32_t triangle, float b1, float b2) const;  // as Uv where there is no second set
    std::array<float, 4> Color(uint32_t triangle, float b1, float b2) const;  // 1 without colours
    float Area(uint32_t triangle) const;
    // The emitting side is pbrt-v3's: vertex normals decide, regardless of ReverseOrientation;
    // those of a triangle are added.
    TriangleSampler Sampler(uint32_t triangle) const;
};

}  // namespace lull
