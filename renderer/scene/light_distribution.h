// Chooses a light for a point: uniformly, by power, or by what each would give near the point.
#pragma once

#include <atomic>
#include <memory>
#include <mutex>

#include "renderer/base/sampling.h"

namespace lull {

// Follows pbrt-v3's light sampling strategies (pbrt-v3's lightdistrib; "spatial" is its default).
class LightDistribution {
  public:
    // Chooses by fixed weights, one a light.
    explicit LightDistribution(std::span<const float> weights);

    // Chooses among `count` lights by the voxel of p within the scene's bounds.
    LightDistribution(int count, const Bounds3f& bounds);

    // Returns the table for p, which stays valid as long as this object. The table of a voxel is
    // made when it is first asked for; it is a function of the voxel alone, so that no order of
    // threads can change it. contribution(light, p, u) estimates what a light gives at p:
    // luminance over density of its sample u, without visibility.
    template <typename Contribution>
    const Distribution1D& Lookup(const Vec3f& p, const Contribution& contribution) const {
        if (voxels.empty()) return fixed;
        const Vec3i v = VoxelOf(p);
        const size_t index = (size_t(v.z()) * resolution.y() + v.y()) * resolution.x() + v.x();
        Voxel& voxel = voxels[index];
        if (!voxel.isReady.load(std::memory_order_acquire)) {
            std::lock_guard lock(locks[index % kLocks]);
            if (!voxel.isReady.load(std::memory_order_relaxed)) {
                voxel.table = Compute(v, contribution);
                voxel.isReady.store(true, std::memory_order_release);
            }
        }
        return voxel.table;
    }

  private:
    static constexpr int kMaxVoxels = 64;  // along the longest axis
    static constexpr int kSamples = 128;   // a voxel
    static constexpr int kLocks = 64;

    Vec3i VoxelOf(const Vec3f& p) const {
        Vec3i v;
        for (int i = 0; i < 3; ++i)
            v[i] =
                std::clamp(int((p[i] - bounds.lower[i]) * voxelsPerUnit[i]), 0, resolution[i] - 1);
        return v;
    }

    // Averages over a Halton set of points in the voxel and on the lights.
    template <typename Contribution>
    Distribution1D Compute(const Vec3i& voxel, const Contribution& contribution) const {
        const Vec3f size = bounds.Diagonal().cwiseQuotient(resolution.cast<float>());
        const Vec3f lower = bounds.lower + size.cwiseProduct(voxel.cast<float>());
        std::vector<float> sums(lightCount, 0.f);
        for (int i = 0; i < kSamples; ++i) {
            const Vec3f t(RadicalInverse(2, i), RadicalInverse(3, i), RadicalInverse(5, i));
            const Vec2f u(RadicalInverse(7, i), RadicalInverse(11, i));
            for (int k = 0; k < lightCount; ++k)
                sums[k] += contribution(k, lower + size.cwiseProduct(t), u);
        }
        return FromContributions(std::move(sums));
    }
    Distribution1D FromContributions(std::vector<float> sums) const;

    Distribution1D fixed;
    int lightCount = 0;
    Bounds3f bounds;
    Vec3i resolution = Vec3i::Zero();
    Vec3f voxelsPerUnit = Vec3f::Zero();
    struct Voxel {
        std::atomic<bool> isReady = false;
        Distribution1D table;
    };
    mutable std::vector<Voxel> voxels;
    mutable std::array<std::mutex, kLocks> locks;
};

}  // namespace lull
