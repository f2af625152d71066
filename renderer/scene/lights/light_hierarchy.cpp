#include "renderer/scene/lights/light_distribution.h"

#include <numbers>

namespace lull {
namespace {

// Takes box, power, sides and emission of `light` into `sum`, and its axis into the sum of axes.
void Gather(const LightBounds& light, LightBounds* sum) {
    sum->box.Extend(light.box);
    sum->axis += light.axis;
    sum->cosEmission = std::min(sum->cosEmission, light.cosEmission);
    sum->power += light.power;
    sum->isTwoSided |= light.isTwoSided;
}

LightBounds Nothing() { return {.axis = Vec3f::Zero(), .cosEmission = 1}; }

// Turns the sum of axes into an axis. Without a common direction, any normal is possible.
void FindAxis(LightBounds* sum) {
    const float norm = sum->axis.norm();
    const bool hasDirection = norm > 1e-4f;
    sum->axis = hasDirection ? Vec3f(sum->axis / norm) : Vec3f(Vec3f::UnitZ());
    sum->cosNormals = hasDirection ? 1 : -1;
}

float CosOfSum(float cosA, float cosB) {
    if (cosA <= -cosB) return -1;
    return cosA * cosB - SafeSqrt(1 - Sqr(cosA)) * SafeSqrt(1 - Sqr(cosB));
}

void Widen(const LightBounds& light, LightBounds* sum) {
    const float cosAxes = std::clamp(sum->axis.dot(light.axis), -1.f, 1.f);
    sum->cosNormals = std::min(
        sum->cosNormals, light.cosNormals == 1 ? cosAxes : CosOfSum(cosAxes, light.cosNormals));
}

LightBounds Merged(std::span<const LightBounds> parts) {
    LightBounds sum = Nothing();
    for (const LightBounds& part : parts) Gather(part, &sum);
    FindAxis(&sum);
    for (const LightBounds& part : parts) Widen(part, &sum);
    return sum;
}

// Returns the cost of having these lights in one node: power times the measures of the directions
// and the places of light (Conty Estevez and Kulla 2018, section 4.4). The sphere around the box
// stands for the latter, as it does where nodes are chosen; unlike the box's area it is positive
// for lights in a line.
double Cost(const LightBounds& b) {
    const double thetaO = std::acos(std::clamp(b.cosNormals, -1.f, 1.f));
    const double thetaE = std::acos(std::clamp(b.cosEmission, -1.f, 1.f));
    const double thetaW = std::min(thetaO + thetaE, std::numbers::pi);
    const double sinO = std::sin(thetaO), cosO = std::cos(thetaO);
    const double directions =
        2 * std::numbers::pi * (1 - cosO) +
        std::numbers::pi / 2 *
            (2 * thetaW * sinO - std::cos(thetaO - 2 * thetaW) - 2 * thetaO * sinO + cosO);
    return double(b.power) * directions * b.box.Diagonal().cast<double>().squaredNorm();
}

Vec3f Center(const LightBounds& b) { return 0.5f * b.box.lower + 0.5f * b.box.upper; }

}  // namespace

// Splits the lights where the costs of both halves are least.
struct LightHierarchy::Builder {
    static constexpr int kBuckets = 12;
    // From here on lights are halved by number, so that no arrangement makes the tree deep.
    static constexpr int kDeep = 48;

    std::span<const LightBounds> lights;
    LightHierarchy& tree;

    struct Cut {
        int axis = -1;
        int bucket = 0;  // the first one behind the cut
        int buckets = 0;
        float lower = 0, scale = 0;

        int BucketOf(const LightBounds& b) const {
            return std::clamp(int((Center(b)[axis] - lower) * scale), 0, buckets - 1);
        }
    };

    Node MakeNode(std::span<const uint32_t> range, uint32_t parent) const {
        LightBounds sum = Nothing();
        for (const uint32_t i : range) Gather(lights[i], &sum);
        FindAxis(&sum);
        // Bound the normals around the axis as it is kept.
        Node node{};
        node.box = sum.box;
        node.power = sum.power;
        node.parent = parent;
        for (int k = 0; k < 3; ++k) {
            node.axis[k] = int16_t(std::lround(sum.axis[k] * kUnit));
            sum.axis[k] = node.axis[k] / kUnit;
        }
        for (const uint32_t i : range) Widen(lights[i], &sum);
        // The axis as it is kept is not quite of unit length.
        constexpr float kMargin = 1e-4f;
        const auto down = [](float cosine) {
            return int16_t(std::floor(std::max(cosine - kMargin, -1.f) * kUnit));
        };
        node.cosNormals = down(sum.cosNormals);
        node.cosEmission = down(sum.cosEmission);
        node.isTwoSided = sum.isTwoSided;
        return node;
    }

    Cut FindCut(std::span<const uint32_t> range) const {
        Bounds3f centers;
        for (const uint32_t i : range) centers.Extend(Center(lights[i]));
        const Vec3f extent = centers.Diagonal();
        Cut best;
        double leastCost = std::numeric_limits<double>::infinity();
        for (int axis = 0; axis < 3; ++axis) {
            const int count = std::min(kBuckets, int(range.size()));
            const float scale = float(count) / extent[axis];
            if (!(extent[axis] > 0) || !std::isfinite(scale)) continue;
            const Cut cut{axis, 0, count, centers.lower[axis], scale};

            std::array<LightBounds, kBuckets> buckets;
            buckets.fill(Nothing());
            for (const uint32_t i : range)
                Gather(lights[i], &buckets[size_t(cut.BucketOf(lights[i]))]);
            for (int b = 0; b < count; ++b) FindAxis(&buckets[size_t(b)]);
            for (const uint32_t i : range)
                Widen(lights[i], &buckets[size_t(cut.BucketOf(lights[i]))]);

            // Close the gaps of empty buckets, which have no bounds.
            std::array<LightBounds, kBuckets> full;
            std::array<int, kBuckets> places{};
            size_t fullCount = 0;
            for (int b = 0; b < count; ++b)
                if (!buckets[size_t(b)].box.IsEmpty()) {
                    places[fullCount] = b;
                    full[fullCount++] = buckets[size_t(b)];
                }
            const std::span<const LightBounds> parts(full.data(), fullCount);
            // Cuts across the longest axis are better (Kr in the paper): boxes stay compact.
            const double thinness = extent.maxCoeff() / extent[axis];
            for (size_t k = 1; k < fullCount; ++k) {
                const double cost =
                    thinness * (Cost(Merged(parts.first(k))) + Cost(Merged(parts.subspan(k))));
                if (cost < leastCost) {
                    leastCost = cost;
                    best = cut;
                    best.bucket = places[k];
                }
            }
        }
        return best;
    }

    size_t Divide(std::span<uint32_t> range, int depth) const {
        if (range.size() > 2 && depth < kDeep) {
            const Cut cut = FindCut(range);
            if (cut.axis >= 0) {
                const auto middle = std::partition(
                    range.begin(), range.end(),
                    [&](const uint32_t i) { return cut.BucketOf(lights[i]) < cut.bucket; });
                if (middle != range.begin() && middle != range.end())
                    return size_t(middle - range.begin());
            }
        }
        return range.size() / 2;
    }

    void Build(std::span<uint32_t> range, uint32_t place, uint32_t parent, int depth) {
        Node node = MakeNode(range, parent);
        node.isLeaf = range.size() == 1;
        node.next = node.isLeaf ? range[0] : uint32_t(tree.nodes.size());
        tree.nodes[place] = node;
        if (node.isLeaf) {
            tree.leafOf[range[0]] = place;
            return;
        }
        tree.nodes.resize(tree.nodes.size() + 2);
        const size_t first = Divide(range, depth);
        Build(range.first(first), node.next, place, depth + 1);
        Build(range.subspan(first), node.next + 1, place, depth + 1);
    }
};

LightHierarchy::LightHierarchy(std::span<const LightBounds> lights, std::vector<int> u)
    : leafOf(lights.size(), kNone), unbounded(std::move(u)) {
    for (const int i : unbounded) leafOf[size_t(i)] = kUnbounded;
    std::vector<uint32_t> order;
    for (size_t i = 0; i < lights.size(); ++i)
        if (leafOf[i] == kNone && lights[i].power > 0) order.push_back(uint32_t(i));
    if (order.empty()) return;
    nodes.reserve(2 * order.size() - 1);
    nodes.resize(1);
    Builder{lights, *this}.Build(order, 0, 0, 0);
}

// Estimates the mean over the lights of a node of power cos(theta_o) cos(theta_i) / distance^2, and
// returns 0 only where bounds say that all give nothing. The paper bounds the mean from above; near
// a node, where that says little, places in its eight octants stand for the lights.
float LightHierarchy::Importance(const Node& node, const Receiver& receiver) {
    // Exclude nodes that lie behind the receiver.
    const Vec3f half = 0.5f * node.box.Diagonal();
    const Vec3f toCenter = node.box.lower + half - receiver.p;
    const float reach = receiver.n.cwiseAbs().dot(half);
    const bool hasNormal = (receiver.n.array() != 0).any();
    const auto heightOf = [&](const Vec3f& to) {
        if (!hasNormal) return to.norm();
        const float height = receiver.n.dot(to);
        return receiver.isTwoSided ? std::abs(height) : height;
    };
    const float height = heightOf(toCenter);
    if (!(height + reach > 0)) return 0;

    // Find the least angle between a normal and the way to the receiver, from the sphere around the
    // box (pbrt 4th ed., 12.6.3).
    const float radius2 = half.squaredNorm(), distance2 = toCenter.squaredNorm();
    float cosLeaving = 1;
    if (distance2 > radius2) {
        const float cosNormals = node.cosNormals / kUnit;
        const float toUnit = -1 / (kUnit * std::sqrt(distance2));
        float cosAxis = (toCenter.x() * node.axis[0] + toCenter.y() * node.axis[1] +
                         toCenter.z() * node.axis[2]) *
                        toUnit;
        cosAxis = std::clamp(node.isTwoSided ? std::abs(cosAxis) : cosAxis, -1.f, 1.f);
        if (cosAxis < cosNormals) {
            const float sinAxis = SafeSqrt(1 - Sqr(cosAxis));
            const float sinNormals = SafeSqrt(1 - Sqr(cosNormals));
            const float c = cosAxis * cosNormals + sinAxis * sinNormals;
            const float s = sinAxis * cosNormals - cosAxis * sinNormals;
            const float sinBox2 = radius2 / distance2, cosBox = std::sqrt(1 - sinBox2);
            if (c < cosBox) cosLeaving = c * cosBox + s * std::sqrt(sinBox2);
        }
        if (cosLeaving <= node.cosEmission / kUnit || cosLeaving <= 0) return 0;
    }

    // Lights partly behind the receiver still contribute.
    constexpr float kLeast = 0.1f;
    const auto arriving = [&](float h, float r) { return std::max(h, kLeast * (h + r)); };
    // Powers and distances are kept apart from the ends of float: sums of two are finite.
    constexpr float kLeastDistance2 = 1e-24f, kMost = 1e37f;
    float sum = 0;
    if (distance2 > 9 * radius2) {
        const float d2 = std::max(distance2, kLeastDistance2);
        sum = arriving(height, reach) / (d2 * std::sqrt(d2));
    } else {
        const Vec3f quarter = 0.5f * half;
        // The mean square of the distance to a place in an octant.
        const float spread = std::max(radius2 / 12, kLeastDistance2);
        for (int octant = 0; octant < 8; ++octant) {
            const Vec3f to = toCenter + Vec3f(octant & 1 ? quarter.x() : -quarter.x(),
                                              octant & 2 ? quarter.y() : -quarter.y(),
                                              octant & 4 ? quarter.z() : -quarter.z());
            const float h = heightOf(to);
            const float d2 = to.squaredNorm() + spread;
            sum += std::max(arriving(h, 0.5f * reach), 0.f) / (d2 * std::sqrt(d2));
        }
        const float far2 = distance2 + radius2 + spread;
        sum = std::max(0.125f * sum, 1e-3f * (height + reach) / (far2 * std::sqrt(far2)));
    }
    return std::min(node.power * cosLeaving * sum, kMost);
}

int LightHierarchy::Sample(const Receiver& receiver, float u, float* pmf) const {
    const float groups = float(unbounded.size()) + (nodes.empty() ? 0.f : 1.f);
    *pmf = 0;
    if (groups == 0) return -1;
    const float scaled = u * groups;
    const size_t group = std::min(size_t(scaled), size_t(groups) - 1);
    float p = 1 / groups;
    if (group < unbounded.size()) {
        *pmf = p;
        return unbounded[group];
    }
    u = std::min(scaled - float(group), kOneMinusEpsilon);

    const Node* node = &nodes[0];
    while (!node->isLeaf) {
        const Node* children = &nodes[node->next];
        const float first = Importance(children[0], receiver);
        const float second = Importance(children[1], receiver);
        const float sum = first + second;
        if (!(sum > 0)) return -1;
        const float border = first / sum;
        const bool isSecond = !(u < border);
        const float share = isSecond ? second / sum : border;
        u = std::min((isSecond ? u - border : u) / share, kOneMinusEpsilon);
        p *= share;
        node = children + isSecond;
    }
    *pmf = p;
    return int(node->next);
}

float LightHierarchy::Pmf(const Receiver& receiver, int light) const {
    uint32_t at = leafOf[size_t(light)];
    if (at == kNone) return 0;
    float p = 1 / (float(unbounded.size()) + (nodes.empty() ? 0.f : 1.f));
    if (at == kUnbounded) return p;
    for (; at != 0; at = nodes[at].parent) {
        const float own = Importance(nodes[at], receiver);
        if (!(own > 0)) return 0;
        const float other = Importance(nodes[((at - 1) ^ 1) + 1], receiver);
        p *= own / (own + other);
    }
    return p;
}

}  // namespace lull
