#include "renderer/guiding/environment_guide.h"

namespace lull {

namespace {

constexpr size_t kTiles = TileShares::kCount;
// The fraction of samples by power alone. Its inverse bounds the weight of light found late.
constexpr float kKept = 0.15f;
// The weight of the mean of the space around a leaf, in samples.
constexpr float kPrior = 4;

// The sums of a node of the tree over space.
struct Sums {
    std::array<float, kTiles> squares = {}, counts = {};
};

using Means = std::array<float, kTiles>;  // of squares

// Finds the probabilities in the leaves of a tree from the record: each tile's mean square, in
// which the space around counts where there are few samples.
class Estimation {
  public:
    Estimation(const SpaceTree& tree, const EnvironmentRecord& record, const TileShares& shares,
               std::vector<TileShares>* leaves)
        : tree(tree), record(record), leaves(leaves), sums(tree.nodes.size()) {
        for (size_t t = 0; t < kTiles; ++t) power[t] = shares.Probability(int(t));
    }

    void Run() {
        Add(0);
        double squares = 0, counts = 0;
        for (size_t t = 0; t < kTiles; ++t) {
            squares += double(sums[0].squares[t]);
            counts += double(sums[0].counts[t]);
        }
        Means means;
        means.fill(counts > 0 && squares > 0 ? float(squares / counts) : 1);
        Fill(0, means);
    }

  private:
    void Add(uint32_t node) {
        Sums& s = sums[node];
        const uint32_t value = tree.nodes[node];
        if (value & SpaceTree::kIsLeaf) {
            const size_t first = size_t(value & ~SpaceTree::kIsLeaf) * kTiles;
            for (size_t t = 0; t < kTiles; ++t) {
                s.squares[t] = record.sums[first + t].Squares();
                s.counts[t] = float(record.sums[first + t].count);
            }
            return;
        }
        for (const uint32_t child : {value, value + 1}) {
            Add(child);
            for (size_t t = 0; t < kTiles; ++t) {
                s.squares[t] += sums[child].squares[t];
                s.counts[t] += sums[child].counts[t];
            }
        }
    }

    void Fill(uint32_t node, const Means& around) {
        Means means;
        const Sums& s = sums[node];
        for (size_t t = 0; t < kTiles; ++t)
            means[t] = (s.squares[t] + kPrior * around[t]) / (s.counts[t] + kPrior);
        const uint32_t value = tree.nodes[node];
        if (value & SpaceTree::kIsLeaf) {
            (*leaves)[value & ~SpaceTree::kIsLeaf] = SharesOf(means);
        } else {
            Fill(value, means);
            Fill(value + 1, means);
        }
    }

    TileShares SharesOf(const Means& means) const {
        std::array<float, kTiles> weights;
        double sum = 0;
        for (size_t t = 0; t < kTiles; ++t) {
            weights[t] = power[t] * std::sqrt(means[t]);
            sum += double(weights[t]);
        }
        const float norm = sum > 0 ? float((1 - double(kKept)) / sum) : 0;
        for (size_t t = 0; t < kTiles; ++t) weights[t] = norm * weights[t] + kKept * power[t];
        return TileShares(weights);
    }

    const SpaceTree& tree;
    const EnvironmentRecord& record;
    std::vector<TileShares>* leaves;
    std::vector<Sums> sums;
    std::array<float, kTiles> power;
};

// Copies the trees, with leaves cut where there are many samples.
class Division {
  public:
    Division(const EnvironmentState& old, double leafSamples)
        : old(old), leafSamples(leafSamples) {}

    EnvironmentState Make() {
        for (int side = 0; side < kSides; ++side) {
            const SpaceTree& from = old.guide.trees[size_t(side)];
            SpaceTree& to = made.guide.trees[size_t(side)];
            to.lower = from.lower;
            to.side = from.side;
            to.nodes.resize(1);
            Copy(from, 0, 0, &to, 0);
            to.Index();
        }
        made.guide.leaves.resize(count);
        return std::move(made);
    }

  private:
    void Copy(const SpaceTree& from, uint32_t source, int depth, SpaceTree* to, uint32_t target) {
        const uint32_t value = from.nodes[source];
        if (!(value & SpaceTree::kIsLeaf)) {
            const uint32_t children = to->MakeChildren(target);
            Copy(from, value, depth + 1, to, children);
            Copy(from, value + 1, depth + 1, to, children + 1);
            return;
        }
        const size_t first = size_t(value & ~SpaceTree::kIsLeaf) * kTiles;
        const double samples = double(old.record.CountOf(first / kTiles));
        Place(first, samples, 1, depth, to, target);
    }

    // Puts a leaf of the old tree at a node, cut until its samples are few; it has a part in
    // `parts` of the sums.
    void Place(size_t first, double samples, uint32_t parts, int depth, SpaceTree* to,
               uint32_t target) {
        if (samples > leafSamples && depth < SpaceTree::kMaxDepth) {
            const uint32_t children = to->MakeChildren(target);
            for (uint32_t i = 0; i < 2; ++i)
                Place(first, samples / 2, 2 * parts, depth + 1, to, children + i);
            return;
        }
        to->nodes[target] = SpaceTree::kIsLeaf | uint32_t(count++);
        for (size_t t = first; t < first + kTiles; ++t) {
            const SquareSum& sum = old.record.sums[t];
            made.record.sums.push_back({sum.squares / parts, sum.count / parts});
        }
    }

    const EnvironmentState& old;
    const double leafSamples;
    EnvironmentState made;
    size_t count = 0;
};

// Returns how many leaves a division would make.
size_t LeavesOf(const EnvironmentState& state, double leafSamples) {
    size_t leaves = 0;
    for (size_t i = 0; i < state.guide.leaves.size(); ++i) {
        auto samples = double(state.record.CountOf(i));
        size_t parts = 1;
        for (; samples > leafSamples; samples /= 2) parts *= 2;
        leaves += parts;
    }
    return leaves;
}

}  // namespace

EnvironmentGuide::EnvironmentGuide(const Bounds3f& bounds, int depth, const TileShares& shares)
    : leaves(size_t(kSides) << depth, shares) {
    for (size_t side = 0; side < kSides; ++side) {
        trees[side] = SpaceTree(bounds, depth);
        for (uint32_t& node : trees[side].nodes)
            if (node & SpaceTree::kIsLeaf) node += uint32_t(side << depth);
        trees[side].Index();
    }
}

uint64_t EnvironmentRecord::CountOf(size_t leaf) const {
    uint64_t count = 0;
    for (const SquareSum& sum : std::span(sums).subspan(leaf * kTiles, kTiles)) count += sum.count;
    return count;
}

EnvironmentState Refine(const EnvironmentState& state, const TileShares& shares,
                        const EnvironmentRefineOptions& options) {
    // In the end no leaf is cut.
    double leafSamples = options.leafSamples;
    while (LeavesOf(state, leafSamples) > std::max(options.mostLeaves, state.guide.leaves.size()))
        leafSamples *= 1.25;
    EnvironmentState made = Division(state, leafSamples).Make();
    for (const SpaceTree& tree : made.guide.trees)
        Estimation(tree, made.record, shares, &made.guide.leaves).Run();
    return made;
}

}  // namespace lull
