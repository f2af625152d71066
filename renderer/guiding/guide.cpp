#include "renderer/guiding/guide.h"

namespace lull {

namespace {

// Goes one step down: takes s to the quadrant's own unit square and returns which it is.
inline int Descend(Vec2f* s) {
    const int x = s->x() >= 0.5f, y = s->y() >= 0.5f;
    *s = {2 * s->x() - float(x), 2 * s->y() - float(y)};
    return x + 2 * y;
}

// Chooses between two shares, of which `sum` is the sum, by u and stretches u over the choice.
inline int Choose(int first, int sum, float* u) {
    const float scaled = *u * float(sum);
    const int choice = scaled >= float(first);
    *u = std::min((choice ? scaled - float(first) : scaled) / float(choice ? sum - first : first),
                  kOneMinusEpsilon);
    return choice;
}

// Factor of the density in a quadrant.
inline float Gain(const QuadNode& node, int q) {
    return float(node.share[size_t(q)]) * (4.f / QuadNode::kWhole);
}

// Returns the angle of (x, y) over 2 pi, in [0, 1]; 0 for (0, 0). The polynomial is a minimax fit
// of the arc tangent, off by 4e-8 at most, in a quarter of the time that std::atan2 takes.
inline float Turn(float y, float x) {
    const float ax = std::abs(x), ay = std::abs(y), larger = std::max(ax, ay);
    const float r = larger > 0 ? std::min(ax, ay) / larger : 0, s = r * r;
    float turn = 0.00108412713f;
    for (const float c : {-0.00534826677f, 0.0126724874f, -0.0210615101f, 0.0315251153f,
                          -0.0530262379f, 0.159154324f})
        turn = turn * s + c;
    turn *= r;
    if (ay > ax) turn = 0.25f - turn;
    if (x < 0) turn = 0.5f - turn;
    return y < 0 ? 1 - turn : turn;
}

}  // namespace

Vec2f SquareFromDirection(const Vec3f& w) {
    return {std::clamp(0.5f * (w.z() + 1), 0.f, kOneMinusEpsilon),
            std::clamp(Turn(w.y(), w.x()), 0.f, kOneMinusEpsilon)};
}

Vec3f DirectionFromSquare(const Vec2f& s) {
    const float z = 2 * s.x() - 1, r = SafeSqrt(1 - z * z), angle = 2 * kPi * s.y();
    return {r * std::cos(angle), r * std::sin(angle), z};
}

Guide::Guide(const Bounds3f& bounds, int depth, int quadDepth) : space(bounds, depth) {
    // The quadtree is complete, too: level after level.
    std::vector<QuadNode> tree(1);
    for (size_t begin = 0, level = 1; level < size_t(quadDepth); ++level) {
        const size_t end = tree.size();
        for (size_t i = begin; i < end; ++i) {
            tree[i].children = uint16_t(tree.size());
            tree[i].isCut = 0b1111;
            tree.resize(tree.size() + 4);
        }
        begin = end;
    }
    for (size_t i = 0; i < size_t(1) << depth; ++i) {
        leaves.push_back({uint32_t(quads.size()), uint32_t(tree.size()), uint32_t(depth), 0});
        quads.insert(quads.end(), tree.begin(), tree.end());
    }
}

Vec3f Guide::Sample(const GuideLeaf& leaf, Vec2f u, float* pdf) const {
    Vec2f corner = Vec2f::Zero();
    float size = 1, density = 0.25f * kInvPi;
    for (const QuadNode *tree = &quads[leaf.firstNode], *node = tree;;) {
        const auto& m = node->share;
        const int below = m[0] + m[1];
        const int y = Choose(below, QuadNode::kWhole, &u.y());
        const int x = Choose(y ? m[2] : m[0], y ? QuadNode::kWhole - below : below, &u.x());
        const int q = x + 2 * y;
        size *= 0.5f;
        corner += Vec2f(float(x), float(y)) * size;
        density *= Gain(*node, q);
        if (!node->IsCut(q)) break;
        node = tree + node->Child(q);
    }
    *pdf = density;
    return DirectionFromSquare((corner + size * u).cwiseMin(kOneMinusEpsilon));
}

float Guide::Pdf(const GuideLeaf& leaf, const Vec3f& w) const {
    Vec2f s = SquareFromDirection(w);
    float density = 0.25f * kInvPi;
    for (const QuadNode *tree = &quads[leaf.firstNode], *node = tree;;) {
        const int q = Descend(&s);
        density *= Gain(*node, q);
        if (!node->IsCut(q)) return density;
        node = tree + node->Child(q);
    }
}

size_t Guide::Quadrant(const GuideLeaf& leaf, const Vec3f& w) const {
    Vec2f s = SquareFromDirection(w);
    for (size_t node = leaf.firstNode;;) {
        const int q = Descend(&s);
        if (!quads[node].IsCut(q)) return 4 * node + size_t(q);
        node = leaf.firstNode + quads[node].Child(q);
    }
}

Vec3f Guide::Jitter(const Vec3f& p, const GuideLeaf& leaf, const Vec3f& u) const {
    Vec3f moved = p;
    for (uint32_t i = 0; i < 3; ++i)
        moved[i] += (u[i] - 0.5f) * (space.side / float(1u << ((leaf.depth + 2 - i) / 3)));
    return moved;
}

size_t Guide::Bytes() const {
    return space.Bytes() + leaves.size() * sizeof(GuideLeaf) + quads.size() * sizeof(QuadNode);
}

}  // namespace lull
