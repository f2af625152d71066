// Represents triangle meshes, in world space or in the space of their object.
#pragma once

#include <optional>
#include <vector>

#include "renderer/scene/interaction.h"
#include "renderer/scene/shapes/shape_sample.h"

namespace lull {

struct Mesh {
    std::vector<Vec3f> p;
    std::vector<Vec3f> n;   // empty or one a vertex; need not be unit
    std::vector<Vec2f> uv;  // empty or one a vertex
    std::vector<std::array<uint32_t, 3>> triangles;
    bool reverseOrientation = false;
    bool flipNormals = false;  // reverseOrientation xor the transform mirrors

    // Fills in everything about the hit but wo, material and light; b1 and b2 weigh the second
    // and third vertex.
    void Interact(uint32_t triangle, float b1, float b2, SurfaceNeeds needs,
                  SurfaceInteraction* hit) const;

    Vec2f Uv(uint32_t triangle, float b1, float b2) const;
    float Area(uint32_t triangle) const;
    // Samples the triangle uniformly by area. Returns nothing for a degenerate configuration.
    std::optional<ShapeSample> Sample(uint32_t triangle, const Vec3f& from, const Vec2f& u) const;
};

}  // namespace lull
