// Chooses a light for a point: uniformly, by power, or by its contribution near the point.
#pragma once

#include <algorithm>
#include <atomic>
#include <memory>
#include <mutex>
#include <span>

#include "renderer/base/memory.h"
#include "renderer/base/sampling.h"
#include "renderer/scene/lights/light.h"

namespace lull {

// Inputs of light selection at a point of a surface or a medium.
struct Receiver {
    Vec3f p = Vec3f::Zero();
    // Geometric, unit, on the visible side; zero if light from anywhere counts.
    Vec3f n = Vec3f::UnitZ();
    bool isTwoSided = true;  // light from behind counts as well: the surface transmits
};

// A binary tree over lights (Conty Estevez and Kulla 2018), as pbrt-v4's BVH light sampler. At each
// node one of the children is chosen by the most that it could contribute, given its box, the cone
// of its normals and its power. Lights that the bounds exclude are never chosen.
class LightHierarchy {
  public:
    // Takes the bounds of all lights; one with power 0 is never chosen by its bounds. Each light of
    // `unbounded` (at infinity, ascending) gets a share as large as all others together. Takes n
    // log n time and 100 bytes a light.
    LightHierarchy(std::span<const LightBounds> lights, std::vector<int> unbounded);

    // Chooses a light with u in [0, 1); `pmf` receives its probability. If no light reaches the
    // receiver, that is 0 and the result is not a light.
    int Sample(const Receiver& receiver, float u, float* pmf) const;

    // Returns the probability with which Sample chooses `light`.
    float Pmf(const Receiver& receiver, int light) const;

    size_t Bytes() const {
        return nodes.size() * sizeof(Node) + leafOf.size() * sizeof(uint32_t) +
               unbounded.size() * sizeof(int);
    }

  private:
    // Cosines and the axis as multiples of 1 / kUnit, rounded so that the bounds hold.
    static constexpr float kUnit = 32767;
    static constexpr uint32_t kNone = ~0u, kUnbounded = ~1u;  // instead of a leaf

    // The children of a node are adjacent, the first at an odd index.
    struct Node {
        Bounds3f box;
        float power;
        std::array<int16_t, 3> axis;
        int16_t cosNormals, cosEmission;
        bool isTwoSided, isLeaf;
        uint32_t next;    // of a leaf its light, of others the first child
        uint32_t parent;  // the root's own is the root
    };
    static_assert(sizeof(Node) == 48);

    struct Builder;

    static float Importance(const Node&, const Receiver&);

    std::vector<Node> nodes;
    std::vector<uint32_t> leafOf;  // by light: its node, kNone or kUnbounded
    std::vector<int> unbounded;
};

// Places in a voxel, and samples of a light, one for each: a Halton set.
struct LightProbes {
    static constexpr int kCount = 128;
    using Numbers = Eigen::Array<float, kCount, 1>;
    using Places = Eigen::Array<float, kCount, 3>;

    LightProbes();
    Places PlacesIn(const Bounds3f& voxel) const;

    Places unit;                  // in the unit cube
    std::array<Vec2f, kCount> u;  // of samples
    Numbers b0, b1;               // the same as SampleUniformTriangle(u)
};

// Returns the sum over the places of luminance over density of a sample each, without visibility.
float Contribution(const Light& light, const LightProbes& probes,
                   const LightProbes::Places& places);

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

// The probabilities of choosing each light: running sums up to 1, or a hierarchy for a receiver.
class LightChoice {
  public:
    explicit LightChoice(std::span<const float> sums) : sums(sums) {}
    LightChoice(const LightHierarchy& hierarchy, const Receiver& receiver)
        : hierarchy(&hierarchy), receiver(receiver) {}
    LightChoice() = default;

    // Chooses a light with u in [0, 1); `pmf` receives its probability, which is positive except
    // for hierarchies in which no light reaches the receiver.
    int Sample(float u, float* pmf) const {
        if (hierarchy) [[unlikely]]
            return hierarchy->Sample(receiver, u, pmf);
        // Count the sums that u has passed; for short tables this is fastest without a branch.
        constexpr size_t kShort = 32;
        int i = 0;
        if (sums.size() <= kShort)
            for (const float s : sums) i += s <= u;
        else
            i = int(std::upper_bound(sums.begin(), sums.end(), u) - sums.begin());
        *pmf = Pmf(i);
        return i;
    }
    float Pmf(int i) const {
        if (hierarchy) [[unlikely]]
            return hierarchy->Pmf(receiver, i);
        return i == 0 ? sums[0] : sums[i] - sums[i - 1];
    }

  private:
    std::span<const float> sums;
    const LightHierarchy* hierarchy = nullptr;
    Receiver receiver;
};

// Follows pbrt-v3's light sampling strategies; "spatial", a table for each voxel, is its default.
class LightDistribution {
  public:
    // Chooses by fixed nonnegative weights, one per light.
    explicit LightDistribution(std::span<const float> weights);

    // Chooses among `count` lights by the voxel of p within the scene's bounds.
    LightDistribution(int count, const Bounds3f& bounds);

    // Returns the choice for a voxel, which stays valid as long as this object. The table of a
    // voxel is made when first needed; it depends on the voxel alone, so that the order of threads
    // cannot change it. contribution(light, probes, places) returns what Contribution() does.
    template <typename Contribution>
    LightChoice Lookup(size_t voxel, const Contribution& contribution) const {
        const std::span<float> sums(tables + voxel * lightCount, lightCount);
        // A table that has not been made is all zeros; its last sum is written last, and shows it.
        std::atomic_ref<float> last(sums.back());
        if (last.load(std::memory_order_acquire) == 0) [[unlikely]]
            MakeTable(voxel, contribution, sums);
        return LightChoice(sums);
    }

    // Starts to load what Lookup() reads of a voxel's table, usually far away in memory.
    void Prefetch(size_t voxel) const {
        const float* table = tables + voxel * lightCount;
        lull::Prefetch(table);
        lull::Prefetch(table + lightCount - 1);
    }

    // Returns the probes of tables of places; there are none of fixed weights.
    const LightProbes& Probes() const { return *probes; }
    // Returns the voxels that the tables are for; of fixed weights it is one.
    const VoxelGrid& Grid() const { return grid; }

  private:
    static constexpr int kMaxVoxels = 64;  // along the longest axis
    static constexpr int kLocks = 64;

    // Makes the voxel's table, unless another thread has. Apart, so that Lookup() can be inlined.
    template <typename Contribution>
    [[gnu::noinline]] void MakeTable(size_t voxel, const Contribution& contribution,
                                     std::span<float> sums) const {
        std::lock_guard lock(locks[voxel % kLocks]);
        std::atomic_ref<float> last(sums.back());
        if (last.load(std::memory_order_relaxed) != 0) return;
        const LightProbes::Places places = probes->PlacesIn(grid.BoundsOf(voxel));
        std::vector<float> made(lightCount);
        for (int k = 0; k < lightCount; ++k) made[k] = contribution(k, *probes, places);
        made = RunningSums(std::move(made));
        std::copy(made.begin(), made.end() - 1, sums.begin());
        last.store(made.back(), std::memory_order_release);
    }

    std::vector<float> RunningSums(std::vector<float> contributions) const;
    void AllocateTables();

    int lightCount = 0;
    VoxelGrid grid;
    std::unique_ptr<const LightProbes> probes;  // null: fixed weights
    // One table after another, voxels in x, y, z order. Only pages that paths visit take memory.
    LazyZeros memory;
    float* tables = nullptr;
    mutable std::array<std::mutex, kLocks> locks;
};

}  // namespace lull
