#include "renderer/scene/light_distribution.h"

#include <numeric>

namespace lull {

LightDistribution::LightDistribution(std::span<const float> weights) : fixed(weights) {}

LightDistribution::LightDistribution(int count, const Bounds3f& bounds)
    : lightCount(count), bounds(bounds) {
    // Make the voxels roughly cubes.
    const Vec3f diagonal = bounds.Diagonal();
    const float longest = std::max(diagonal.maxCoeff(), std::numeric_limits<float>::min());
    for (int i = 0; i < 3; ++i) {
        resolution[i] = std::max(1, int(std::round(diagonal[i] / longest * float(kMaxVoxels))));
        voxelsPerUnit[i] = diagonal[i] > 0 ? resolution[i] / diagonal[i] : 0;
    }
    voxels = std::vector<Voxel>(size_t(resolution.x()) * resolution.y() * resolution.z());
}

Distribution1D LightDistribution::FromContributions(std::vector<float> sums) const {
    // Leave every light some probability: the points may all have missed where it shines.
    const float sum = std::accumulate(sums.begin(), sums.end(), 0.f);
    const float average = sum / (float(kSamples) * lightCount);
    const float least = average > 0 ? 0.001f * average : 1.f;
    for (float& s : sums) s = std::max(s, least);
    return Distribution1D(sums);
}

}  // namespace lull
