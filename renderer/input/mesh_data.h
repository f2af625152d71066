// A triangle mesh as a file or a subdivision gives it.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "renderer/base/math.h"

namespace lull {

// Normals need not have unit length: as in pbrt-v3 their lengths weigh in interpolation, and a
// zero normal stands for the triangle's own.
struct MeshData {
    std::vector<Vec3f> positions;
    std::vector<Vec3f> normals;                      // none or one per position
    std::vector<Vec2f> uvs;                          // none or one per position
    std::vector<std::array<uint32_t, 3>> triangles;  // into positions
    std::vector<int> faceIndices;                    // none or one per triangle
};

}  // namespace lull
