// Divides a box into voxels.
#pragma once

#include <algorithm>

#include "renderer/base/math.h"

namespace lull {

struct VoxelGrid {
    // One voxel, in which every point lies.
    VoxelGrid() = default;
    // Roughly cubes, at most `most` along the longest axis of the bounds.
    VoxelGrid(const Bounds3f& bounds, int most);

    size_t Count() const { return size_t(resolution.z()) * resolution.y() * resolution.x(); }
    // Returns the voxel of p, of points outside the bounds one at the border. Numbers ascend along
    // x first, then y, then z.
    size_t VoxelOf(const Vec3f& p) const {
        Vec3i v;
        for (int i = 0; i < 3; ++i)
            v[i] =
                std::clamp(int((p[i] - bounds.lower[i]) * voxelsPerUnit[i]), 0, resolution[i] - 1);
        return (size_t(v.z()) * resolution.y() + v.y()) * resolution.x() + v.x();
    }
    Bounds3f BoundsOf(size_t voxel) const;

    Bounds3f bounds;
    Vec3i resolution = Vec3i::Ones();
    Vec3f voxelsPerUnit = Vec3f::Zero();
};

}  // namespace lull
