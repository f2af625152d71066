#include "renderer/scene/lights/voxel_grid.h"

#include <cmath>
#include <limits>

namespace lull {

VoxelGrid::VoxelGrid(const Bounds3f& bounds, int most) : bounds(bounds) {
    const Vec3f diagonal = bounds.Diagonal();
    const float longest = std::max(diagonal.maxCoeff(), std::numeric_limits<float>::min());
    for (int i = 0; i < 3; ++i) {
        resolution[i] = std::max(1, int(std::round(diagonal[i] / longest * float(most))));
        voxelsPerUnit[i] = diagonal[i] > 0 ? resolution[i] / diagonal[i] : 0;
    }
}

Bounds3f VoxelGrid::BoundsOf(size_t voxel) const {
    const Vec3i v(int(voxel % resolution.x()), int(voxel / resolution.x() % resolution.y()),
                  int(voxel / resolution.x() / resolution.y()));
    const Vec3f size = bounds.Diagonal().cwiseQuotient(resolution.cast<float>());
    const Vec3f lower = bounds.lower + size.cwiseProduct(v.cast<float>());
    return {lower, lower + size};
}

}  // namespace lull
