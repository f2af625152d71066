// Knows which tiles of an environment map bring light to a place, occlusion included: for each side
// of surfaces a binary tree over space, each leaf of which has probabilities of the tiles.
#pragma once

#include "renderer/base/memory.h"
#include "renderer/base/tile_shares.h"
#include "renderer/guiding/sides.h"
#include "renderer/guiding/space_tree.h"
#include "renderer/guiding/square_sum.h"

namespace lull {

// Constant while paths are traced.
class EnvironmentGuide {
  public:
    EnvironmentGuide() = default;
    // Divides the cube around the bounds into 2^depth leaves a side, all of the same probabilities.
    EnvironmentGuide(const Bounds3f& bounds, int depth, const TileShares& shares);

    // Returns the probabilities at p, on a side; they stay where they are as long as the guide.
    const TileShares& Find(const Vec3f& p, int side) const {
        return leaves[trees[size_t(side)].Find(p)];
    }
    // Returns the number of a leaf that Find() has returned.
    size_t NumberOf(const TileShares* leaf) const { return size_t(leaf - leaves.data()); }

    bool IsEmpty() const { return leaves.empty(); }

    // The trees, to build and store them. Leaves of all trees are numbered together.
    std::array<SpaceTree, kSides> trees;
    std::vector<TileShares> leaves;
};

// Sums up what samples of the map have brought, for the next guide.
class EnvironmentRecord {
  public:
    EnvironmentRecord() = default;
    explicit EnvironmentRecord(const EnvironmentGuide& guide)
        : sums(guide.leaves.size() * TileShares::kCount) {}

    // Records a sample of a tile. `brought`: its light, relative to that of the tile on a white
    // diffuse surface that faces it.
    void Add(size_t leaf, int tile, float brought) {
        sums[leaf * TileShares::kCount + size_t(tile)].Add(brought, kLargest);
    }
    // Starts to load what Add() changes.
    void Prefetch(size_t leaf, int tile) const {
        lull::Prefetch(&sums[leaf * TileShares::kCount + size_t(tile)]);
    }

    // Returns how many samples a leaf has.
    uint64_t CountOf(size_t leaf) const;

    static constexpr float kLargest = 0x1p8f;  // of squares
    std::vector<SquareSum> sums;               // by leaf, then tile
};

struct EnvironmentState {
    EnvironmentGuide guide;
    EnvironmentRecord record;  // of all that has been found so far
};

struct EnvironmentRefineOptions {
    double leafSamples = 1000;  // a leaf that has more is cut
    size_t mostLeaves = 2000;   // of all sides; leaves are larger where there would be more
};

// Returns a guide that chooses each tile by the root of the mean square of what its samples have
// brought, which is what has the least variance, and a record of as many leaves, for what comes
// next to add to. `shares`: sampling by power alone, a part of which each leaf keeps.
EnvironmentState Refine(const EnvironmentState&, const TileShares& shares,
                        const EnvironmentRefineOptions&);

}  // namespace lull
