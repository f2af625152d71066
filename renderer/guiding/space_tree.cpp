#include "renderer/guiding/space_tree.h"

namespace lull {

namespace {

constexpr int kCellBits = SpaceTree::kMaxDepth / 3;  // of a coordinate

}  // namespace

SpaceTree::SpaceTree(const Bounds3f& bounds, int depth) {
    if (!bounds.IsEmpty()) {
        // A little more, so that nothing lies on the border.
        side = std::max(1.002f * bounds.Diagonal().maxCoeff(), 1e-20f);
        if (!(side < kInfinity)) side = std::numeric_limits<float>::max();
        lower = 0.5f * bounds.lower + 0.5f * bounds.upper - Vec3f::Constant(0.5f * side);
    }
    // Complete: level after level.
    const size_t inner = (size_t(1) << depth) - 1, leafCount = inner + 1;
    for (size_t i = 0; i < inner; ++i) nodes.push_back(uint32_t(2 * i + 1));
    for (size_t i = 0; i < leafCount; ++i) nodes.push_back(kIsLeaf | uint32_t(i));
    Index();
}

void SpaceTree::Index() {
    cellsPerUnit = float(1 << kCellBits) / side;
    constexpr uint32_t kCells = 1u << (3 * kIndexBits);
    entries.resize(kCells);
    for (uint32_t cell = 0; cell < kCells; ++cell) {
        uint32_t node = nodes[0];
        // x has the highest bits of the cell's number, z the lowest; the tree cuts them in turn.
        for (int bit = kIndexBits - 1; bit >= 0; --bit)
            for (int axis = 2; axis >= 0 && !(node & kIsLeaf); --axis)
                node = nodes[node + ((cell >> (axis * kIndexBits + bit)) & 1)];
        entries[cell] = node;
    }
}

uint32_t SpaceTree::Find(const Vec3f& p) const {
    constexpr int kRest = kCellBits - kIndexBits;
    constexpr float kLast = float((1 << kCellBits) - 1);
    std::array<uint32_t, 3> cell;
    for (int i = 0; i < 3; ++i) {
        const float x = (p[i] - lower[i]) * cellsPerUnit;
        cell[i] = x > 0 ? uint32_t(std::min(x, kLast)) : 0;
    }
    uint32_t node = entries[(((cell[0] >> kRest) << kIndexBits | cell[1] >> kRest) << kIndexBits) |
                            cell[2] >> kRest];
    for (int bit = kRest - 1; !(node & kIsLeaf); --bit)
        for (int axis = 0; axis < 3 && !(node & kIsLeaf); ++axis)
            node = nodes[node + ((cell[axis] >> bit) & 1)];
    return node & ~kIsLeaf;
}

bool SpaceTree::IsValid(size_t leaves) const {
    if (nodes.empty() || !(side > 0 && side < kInfinity) || !lower.allFinite()) return false;
    std::vector<int> depth(nodes.size(), -1);
    depth[0] = 0;
    for (size_t i = 0; i < nodes.size(); ++i) {
        const uint32_t node = nodes[i];
        if (depth[i] < 0 || depth[i] > kMaxDepth) return false;
        if (node & kIsLeaf) {
            if ((node & ~kIsLeaf) >= leaves) return false;
            continue;
        }
        if (node <= i || size_t(node) + 1 >= nodes.size()) return false;
        depth[node] = depth[node + 1] = depth[i] + 1;
    }
    return true;
}

}  // namespace lull
