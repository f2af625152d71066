// A binary tree over space, which finds the leaf at a point.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "renderer/base/math.h"

namespace lull {

// Cuts a cube in halves, along x, y and z in turn. Constant while paths are traced.
class SpaceTree {
  public:
    static constexpr int kMaxDepth = 48;

    SpaceTree() = default;
    // Cuts the cube around the bounds `depth` times; the leaves are numbered from 0.
    SpaceTree(const Bounds3f& bounds, int depth);

    // Has to be called when nodes or cube have been changed, and before Find().
    void Index();
    // Returns the number of the leaf at p; for points outside the cube, of one at the border.
    uint32_t Find(const Vec3f& p) const;

    // Makes two children of a node and returns the first one.
    uint32_t MakeChildren(uint32_t node) {
        const auto children = uint32_t(nodes.size());
        nodes[node] = children;
        nodes.resize(children + 2);
        return children;
    }
    // Returns whether every walk ends at one of `leaves` leaves, at most kMaxDepth steps from the
    // root.
    bool IsValid(size_t leaves) const;
    size_t Bytes() const { return (nodes.size() + entries.size()) * sizeof(uint32_t); }

    // A node is the index of the first of its two children, or a leaf's with kIsLeaf set.
    static constexpr uint32_t kIsLeaf = 0x80000000u;
    Vec3f lower = Vec3f::Zero();  // of the cube
    float side = 1;               // of the cube
    std::vector<uint32_t> nodes;

  private:
    static constexpr int kIndexBits = 4;  // of each coordinate

    float cellsPerUnit = 1;  // of the 2^16 of a side
    // The end of a walk through the nodes after its first 3 * kIndexBits steps, or before, cell by
    // cell: most of the way to a leaf.
    std::vector<uint32_t> entries;
};

}  // namespace lull
