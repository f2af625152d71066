// Knows where light comes from, place by place: a binary tree over space, each leaf of which has a
// quadtree over directions (Müller, Gross, Novák: Practical Path Guiding, CGF 36(4), 2017).
#pragma once

#include <bit>
#include <cstddef>
#include <span>
#include <vector>

#include "renderer/guiding/space_tree.h"

namespace lull {

// Maps unit directions to the unit square, solid angles to equal shares of its area: the height
// over the xy plane, and the angle around z.
Vec2f SquareFromDirection(const Vec3f& w);
Vec3f DirectionFromSquare(const Vec2f& s);

// Cuts a square into quadrants: 0 and 1 below in y, 2 and 3 above. Small, as the cost of a walk
// down a tree is its memory traffic.
struct QuadNode {
    static constexpr int kWhole = 1 << 16;

    std::array<uint16_t, 4> share = {1 << 14, 1 << 14, 1 << 14, 1 << 14};  // > 0; sum kWhole
    uint16_t children = 0;  // from the first node of the tree on: nodes of its quadrants, in turn
    uint16_t isCut = 0;     // bit q: quadrant q has a node of its own; else it is even

    bool IsCut(int q) const { return (isCut >> q) & 1; }
    uint32_t Child(int q) const {
        return children + uint32_t(std::popcount(uint32_t(isCut) & ((1u << q) - 1)));
    }
};

struct GuideLeaf {
    uint32_t firstNode = 0, nodeCount = 1;  // of its quadtree, the root first, children later
    uint32_t depth = 0;                     // in the tree over space
    float fraction = 0;  // of the paths there that the guide directs; 0: has nothing to say
};

// Constant while paths are traced.
class Guide {
  public:
    Guide() = default;
    // Cuts the cube around the bounds, `depth` times, and directions into 4^quadDepth squares, all
    // even.
    Guide(const Bounds3f& bounds, int depth, int quadDepth);

    // Returns the leaf at p; for points outside the bounds, one at the border.
    uint32_t Find(const Vec3f& p) const { return space.Find(p); }
    const GuideLeaf& Leaf(uint32_t i) const { return leaves[i]; }
    // Asks for the leaf's quadtree, which is about to be walked down.
    void Prefetch(const GuideLeaf& leaf) const {
        const QuadNode* tree = &quads[leaf.firstNode];
        for (uint32_t i = 0; i < std::min(leaf.nodeCount, 24u); i += 64 / sizeof(QuadNode))
            __builtin_prefetch(tree + i);
    }

    // Turns u in [0, 1)^2 into a unit direction by the density of the leaf; `pdf` receives it,
    // 1/sr.
    Vec3f Sample(const GuideLeaf& leaf, Vec2f u, float* pdf) const;
    // Returns the density, 1/sr, of the unit direction.
    float Pdf(const GuideLeaf& leaf, const Vec3f& w) const;

    // Returns the smallest quadrant that holds the unit direction: 4 times its node, from the first
    // of all trees on, plus its place there.
    size_t Quadrant(const GuideLeaf& leaf, const Vec3f& w) const;
    // Moves p within the size of its leaf, as u in [0, 1)^3 says.
    Vec3f Jitter(const Vec3f& p, const GuideLeaf& leaf, const Vec3f& u) const;

    size_t Bytes() const;

    // The trees, for those who build, store and record.
    SpaceTree space;
    std::vector<GuideLeaf> leaves;
    std::vector<QuadNode> quads;
};

}  // namespace lull
