#include "renderer/guiding/guide.h"

namespace lull {

namespace {

// Goes one step down: takes s to the quadrant's own unit square and returns which it is.
inline int Descend(Vec2f* s) {
    const int x = s->x() >= 0.5f, y = s->y() >= 0.5f;
    *s = {2 * s->x() - float(x), 2 * s->y() - float(y)};
    return x + 2 * y;
}

// Chooses between two shares by u and stretches u over the choice.
inline int Choose(float first, float second, float* u) {
    const float split = first / (first + second);
    if (*u < split) {
        *u = std::min(*u / split, kOneMinusEpsilon);
        return 0;
    }
    *u = std::min((*u - split) / (1 - split), kOneMinusEpsilon);
    return 1;
}

}  // namespace

Vec2f SquareFromDirection(const Vec3f& w) {
    const float angle = std::atan2(w.y(), w.x()) * (0.5f * kInvPi);
    return {std::clamp(0.5f * (w.z() + 1), 0.f, kOneMinusEpsilon),
            std::clamp(angle < 0 ? angle + 1 : angle, 0.f, kOneMinusEpsilon)};
}

Vec3f DirectionFromSquare(const Vec2f& s) {
    const float z = 2 * s.x() - 1, r = SafeSqrt(1 - z * z), angle = 2 * kPi * s.y();
    return {r * std::cos(angle), r * std::sin(angle), z};
}

Guide::Guide(const Bounds3f& bounds, int depth, int quadDepth) {
    if (!bounds.IsEmpty()) {
        // A little more, so that nothing lies on the border.
        side = std::max(1.002f * bounds.Diagonal().maxCoeff(), 1e-20f);
        if (!(side < kInfinity)) side = std::numeric_limits<float>::max();
        lower = 0.5f * bounds.lower + 0.5f * bounds.upper - Vec3f::Constant(0.5f * side);
    }
    // Both trees are complete: level after level.
    const size_t inner = (size_t(1) << depth) - 1, leafCount = inner + 1;
    for (size_t i = 0; i < inner; ++i) nodes.push_back(uint32_t(2 * i + 1));
    QuadNode node;
    std::vector<QuadNode> tree(1, node);
    size_t begin = 0;
    for (int level = 1; level < quadDepth; ++level) {
        const size_t end = tree.size();
        for (size_t i = begin; i < end; ++i)
            for (int q = 0; q < 4; ++q) {
                tree[i].child[q] = uint16_t(tree.size());
                tree.push_back(node);
            }
        begin = end;
    }
    for (size_t i = 0; i < leafCount; ++i) {
        nodes.push_back(kIsLeaf | uint32_t(i));
        leaves.push_back({uint32_t(quads.size()), uint32_t(tree.size()), uint32_t(depth), 0});
        quads.insert(quads.end(), tree.begin(), tree.end());
    }
}

uint32_t Guide::Find(const Vec3f& p) const {
    constexpr int kBits = kMaxDepth / 3;
    std::array<uint32_t, 3> cell;
    for (int i = 0; i < 3; ++i) {
        const float x = (p[i] - lower[i]) / side;
        cell[i] = x > 0 ? uint32_t(std::min(x, kOneMinusEpsilon) * float(1 << kBits)) : 0;
    }
    uint32_t node = nodes[0];
    for (int bit = kBits - 1; !(node & kIsLeaf); --bit)
        for (int axis = 0; axis < 3 && !(node & kIsLeaf); ++axis)
            node = nodes[node + ((cell[axis] >> bit) & 1)];
    return node & ~kIsLeaf;
}

Vec3f Guide::Sample(const GuideLeaf& leaf, Vec2f u, float* pdf) const {
    Vec2f corner = Vec2f::Zero();
    float size = 1, density = 0.25f * kInvPi;
    for (const QuadNode *tree = &quads[leaf.firstNode], *node = tree;;) {
        const auto& m = node->share;
        const int y = Choose(m[0] + m[1], m[2] + m[3], &u.y());
        const int x = Choose(m[2 * y], m[2 * y + 1], &u.x());
        const int q = x + 2 * y;
        size *= 0.5f;
        corner += Vec2f(float(x), float(y)) * size;
        density *= 4 * m[q];
        if (node->child[q] == 0) break;
        node = tree + node->child[q];
    }
    *pdf = density;
    return DirectionFromSquare((corner + size * u).cwiseMin(kOneMinusEpsilon));
}

float Guide::Pdf(const GuideLeaf& leaf, const Vec3f& w) const {
    Vec2f s = SquareFromDirection(w);
    float density = 0.25f * kInvPi;
    for (const QuadNode *tree = &quads[leaf.firstNode], *node = tree;;) {
        const int q = Descend(&s);
        density *= 4 * node->share[q];
        if (node->child[q] == 0) return density;
        node = tree + node->child[q];
    }
}

size_t Guide::Quadrant(const GuideLeaf& leaf, const Vec3f& w) const {
    Vec2f s = SquareFromDirection(w);
    for (size_t node = leaf.firstNode;;) {
        const int q = Descend(&s);
        if (quads[node].child[q] == 0) return 4 * node + size_t(q);
        node = leaf.firstNode + quads[node].child[q];
    }
}

Vec3f Guide::Jitter(const Vec3f& p, const GuideLeaf& leaf, const Vec3f& u) const {
    Vec3f moved = p;
    for (uint32_t i = 0; i < 3; ++i)
        moved[i] += (u[i] - 0.5f) * std::ldexp(side, -int((leaf.depth + 2 - i) / 3));
    return moved;
}

size_t Guide::Bytes() const {
    return nodes.size() * sizeof(uint32_t) + leaves.size() * sizeof(GuideLeaf) +
           quads.size() * sizeof(QuadNode);
}

}  // namespace lull
