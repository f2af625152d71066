#include "renderer/scene/lights/light_distribution.h"

#include <cmath>
#include <limits>
#include <numeric>

namespace lull {
namespace {

// Turns weights into running sums of probabilities that end at exactly 1. Weights without a
// positive finite sum give the uniform choice.
std::vector<float> Normalized(std::vector<float> weights) {
    double total = std::accumulate(weights.begin(), weights.end(), 0.0);
    if (!(total > 0) || !std::isfinite(total)) {
        std::fill(weights.begin(), weights.end(), 1.f);
        total = double(weights.size());
    }
    double running = 0;
    for (float& w : weights) {
        running += w;
        w = std::min(float(running / total), 1.f);
    }
    // Lights of weight 0 at the end share the last sum, so that they are never chosen.
    const float last = weights.back();
    for (auto w = weights.rbegin(); w != weights.rend() && *w == last; ++w) *w = 1;
    return weights;
}

}  // namespace

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

LightDistribution::LightDistribution(std::span<const float> weights)
    : lightCount(int(weights.size())) {
    AllocateTables();
    const std::vector<float> sums = Normalized({weights.begin(), weights.end()});
    std::copy(sums.begin(), sums.end(), tables);
}

LightDistribution::LightDistribution(int count, const Bounds3f& bounds) : lightCount(count) {
    // Take fewer voxels where there are so many lights that the tables could not even be addressed.
    constexpr double kMaxEntries = double(1ull << 31);
    for (int most = kMaxVoxels; most >= 1; most /= 2) {
        grid = VoxelGrid(bounds, most);
        if (double(grid.Count()) * count <= kMaxEntries) break;
    }
    probes = std::make_unique<const LightProbes>();
    AllocateTables();
}

void LightDistribution::AllocateTables() {
    memory = LazyZeros(grid.Count() * lightCount * sizeof(float));
    tables = static_cast<float*>(memory.Data());
}

std::vector<float> LightDistribution::RunningSums(std::vector<float> contributions) const {
    // Leave every light some probability: the points may all have missed where it shines.
    const float sum = std::accumulate(contributions.begin(), contributions.end(), 0.f);
    const float average = sum / (float(LightProbes::kCount) * lightCount);
    const float least = average > 0 ? 0.001f * average : 1.f;
    for (float& c : contributions) c = std::max(c, least);
    return Normalized(std::move(contributions));
}

}  // namespace lull
