#include "renderer/guiding/guide_refine.h"

namespace lull {

namespace {

constexpr int kMaxQuadDepth = 10;

using Masses = std::array<double, 4>;

// A quadtree and the light in its quadrants.
struct Quadtree {
    std::vector<QuadNode> nodes;
    std::vector<Masses> light;  // 0 where a quadrant has children
};

// Returns the masses over their sum; even where that is 0.
std::array<uint16_t, 4> SharesOf(const Masses& mass) {
    QuadNode node;
    const double sum = mass[0] + mass[1] + mass[2] + mass[3];
    if (!(sum > 0)) return node.share;
    int left = QuadNode::kWhole;
    std::array<int, 4> share;
    for (size_t q = 0; q < 4; ++q)
        left -= share[q] = std::max(1, int(mass[q] / sum * QuadNode::kWhole + 0.5));
    *std::max_element(share.begin(), share.end()) += left;  // the rounding error
    for (size_t q = 0; q < 4; ++q) node.share[q] = uint16_t(share[q]);
    return node.share;
}

// Makes the quadtree of one leaf.
class TreeBuilder {
  public:
    TreeBuilder(const GuideState& state, const GuideLeaf& leaf, float share, bool cuts)
        : nodes(&state.guide.quads[leaf.firstNode]),
          sums(&state.record.sums[4 * size_t(leaf.firstNode)]),
          masses(leaf.nodeCount),
          total(SumOf(0)),
          least(share * total),
          cuts(cuts) {}

    // Returns an empty tree where nothing was recorded.
    Quadtree Build() {
        if (total > 0) {
            Grow(1);
            Fill(0, masses[0], &nodes[0], 0);
        }
        return std::move(built);
    }

  private:
    // Fills in the masses of an old node and of those below.
    double SumOf(uint32_t node) {
        for (int q = 0; q < 4; ++q)
            masses[node][size_t(q)] = nodes[node].IsCut(q) ? SumOf(nodes[node].Child(q))
                                                           : double(sums[4 * node + uint32_t(q)]);
        const Masses& m = masses[node];
        return m[0] + m[1] + m[2] + m[3];
    }

    size_t Grow(int count) {
        const size_t first = built.nodes.size();
        built.nodes.resize(first + size_t(count));
        built.light.resize(first + size_t(count));
        return first;
    }

    // Fills in a node of these masses, and makes its subtree: as below `old`, the node that was
    // there before, or even where there was none (null).
    void Fill(size_t place, const Masses& mass, const QuadNode* old, int depth) {
        QuadNode node{.share = SharesOf(mass)};
        for (size_t q = 0; q < 4; ++q) {
            const bool hadChild = old && old->IsCut(int(q));
            if (mass[q] > least && depth + 1 < kMaxQuadDepth && (hadChild || cuts))
                node.isCut |= uint16_t(1u << q);
        }
        if (node.isCut) node.children = uint16_t(Grow(std::popcount(node.isCut)));
        built.nodes[place] = node;
        built.light[place] = mass;
        for (int q = 0; q < 4; ++q) {
            if (!node.IsCut(q)) continue;
            const double m = mass[size_t(q)] / 4;
            const bool hadChild = old && old->IsCut(q);
            const uint32_t below = hadChild ? old->Child(q) : 0;
            Fill(node.Child(q), hadChild ? masses[below] : Masses{m, m, m, m},
                 hadChild ? &nodes[below] : nullptr, depth + 1);
            built.light[place][size_t(q)] = 0;
        }
    }

    const QuadNode* nodes;  // the old tree
    const uint64_t* sums;
    std::vector<Masses> masses;
    const double total, least;
    const bool cuts;
    Quadtree built;
};

float BestFraction(const GuideRecord::LeafSums& sums) {
    const auto least = std::min_element(sums.cost.begin(), sums.cost.end());
    return GuideRecord::kFractions[size_t(least - sums.cost.begin())];
}

size_t BytesOf(const GuideState& state) { return state.guide.Bytes() + state.record.Bytes(); }

// Copies the tree over space, with new quadtrees. Gives up when the copy gets too large, while
// something can be done about it.
class Refinement {
  public:
    Refinement(const GuideState& old, const RefineOptions& options, bool cuts)
        : old(old), options(options), cuts(cuts) {}

    GuideState Make() {
        made.guide.space.lower = old.guide.space.lower;
        made.guide.space.side = old.guide.space.side;
        made.guide.space.nodes.resize(1);
        Copy(0, 0);
        made.guide.space.Index();
        return std::move(made);
    }

  private:
    void Copy(uint32_t from, uint32_t to) {
        if (cuts && BytesOf(made) > options.maxBytes && options.quadrantShare <= 1) return;
        const uint32_t node = old.guide.space.nodes[from];
        if (!(node & SpaceTree::kIsLeaf)) {
            const uint32_t children = made.guide.space.MakeChildren(to);
            Copy(node, children);
            Copy(node + 1, children + 1);
            return;
        }
        const uint32_t index = node & ~SpaceTree::kIsLeaf;
        GuideLeaf leaf = old.guide.leaves[index];
        const GuideRecord::LeafSums& sums = old.record.leaves[index];
        Quadtree tree = TreeBuilder(old, leaf, options.quadrantShare, cuts).Build();
        leaf.fraction = tree.nodes.empty() ? 0 : options.knowsFractions ? BestFraction(sums) : 0.5f;
        if (tree.nodes.empty()) tree = {{QuadNode()}, {Masses()}};
        Place(to, leaf, double(sums.vertices), 1, tree);
    }

    // Puts a leaf at a node, split by its number of vertices; `part` is its fraction of the old
    // one.
    void Place(uint32_t node, GuideLeaf leaf, double vertices, double part, const Quadtree& tree) {
        if (cuts && vertices > options.leafVertices && leaf.depth < SpaceTree::kMaxDepth) {
            const uint32_t children = made.guide.space.MakeChildren(node);
            ++leaf.depth;
            for (uint32_t i = 0; i < 2; ++i)
                Place(children + i, leaf, vertices / 2, part / 2, tree);
            return;
        }
        Guide& guide = made.guide;
        guide.space.nodes[node] = SpaceTree::kIsLeaf | uint32_t(guide.leaves.size());
        leaf.firstNode = uint32_t(guide.quads.size());
        leaf.nodeCount = uint32_t(tree.nodes.size());
        guide.leaves.push_back(leaf);
        guide.quads.insert(guide.quads.end(), tree.nodes.begin(), tree.nodes.end());
        made.record.leaves.push_back({uint64_t(vertices), {}});
        for (const Masses& light : tree.light)
            for (const double sum : light) made.record.sums.push_back(uint64_t(sum * part));
    }

    const GuideState& old;
    const RefineOptions& options;
    const bool cuts;
    GuideState made;
};

}  // namespace

GuideState Refine(const GuideState& state, const RefineOptions& options) {
    // In the end no leaf is cut and all quadtrees are single nodes, which is less than there was.
    RefineOptions coarser = options;
    for (;;) {
        GuideState made = Refinement(state, coarser, true).Make();
        if (BytesOf(made) <= options.maxBytes || coarser.quadrantShare > 1) return made;
        coarser.leafVertices *= 1.5;
        coarser.quadrantShare *= 1.25f;
    }
}

Guide FreezeGuide(const GuideState& state, const RefineOptions& options) {
    return std::move(Refinement(state, options, false).Make().guide);
}

}  // namespace lull
