// Divides polygons into triangles.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "renderer/base/math.h"

namespace lull {

inline constexpr size_t kMostPolygonCorners = 256;

// Returns the triangles of a simple polygon of 3 to kMostPolygonCorners corners, by the numbers of
// its corners. Where it is convex, those of a fan about the first, as in pbrt-v3's quads; so it is
// where `positions` lacks one of its vertices.
std::vector<std::array<size_t, 3>> TrianglesOf(std::span<const uint32_t> vertices,
                                               std::span<const Vec3f> positions);

}  // namespace lull
