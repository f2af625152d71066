// Interpolates by Catmull-Rom splines through unevenly spaced nodes, and samples by them.
#pragma once

#include <optional>
#include <span>

#include "renderer/base/math.h"

namespace lull {

// The four nodes that a spline reads at a point, and their weights (pbrt 3rd ed., 8.6.1).
// Nodes beyond the ends have weight 0.
struct SplineWeights {
    int first;
    std::array<float, 4> w;
};

// Returns the interval between ascending nodes that contains x; the first or last if none does.
inline int IntervalOf(std::span<const float> nodes, float x) {
    const auto above = std::upper_bound(nodes.begin(), nodes.end(), x);
    return std::clamp(int(above - nodes.begin()) - 1, 0, int(nodes.size()) - 2);
}

// Returns the weights at x; nothing if it is outside the nodes.
inline std::optional<SplineWeights> WeightsAt(std::span<const float> nodes, float x) {
    if (!(x >= nodes.front() && x <= nodes.back())) return {};
    const int k = IntervalOf(nodes, x), n = int(nodes.size());
    const float x0 = nodes[k], x1 = nodes[k + 1], width = x1 - x0;
    const float t = (x - x0) / width, t2 = t * t, t3 = t2 * t;
    SplineWeights s{k - 1, {0, 2 * t3 - 3 * t2 + 1, 3 * t2 - 2 * t3, 0}};
    // The slopes at both ends are differences of the neighbours, one-sided at the first and last
    // node.
    const float atStart = t3 - 2 * t2 + t, atEnd = t3 - t2;
    if (k > 0) {
        const float slope = atStart * width / (x1 - nodes[k - 1]);
        s.w[0] -= slope;
        s.w[2] += slope;
    } else {
        s.w[1] -= atStart;
        s.w[2] += atStart;
    }
    if (k + 2 < n) {
        const float slope = atEnd * width / (nodes[k + 2] - x0);
        s.w[1] -= slope;
        s.w[3] += slope;
    } else {
        s.w[1] -= atEnd;
        s.w[2] += atEnd;
    }
    return s;
}

// Interpolates between the rows of a table with one value per entry, at column i.
template <typename At>
float BetweenRows(const SplineWeights& o, const At& at, int i) {
    float sum = 0;
    for (int b = 0; b < 4; ++b)
        if (o.w[b] != 0) sum += o.w[b] * at(o.first + b, i);
    return sum;
}

// Samples x from the spline through value(i) at the nodes, whose integral up to node i is cdf(i),
// inverting it by Newton's method with bisection (pbrt 3rd ed., 14.1.5).
template <typename Value, typename Cdf>
float SampleSpline(std::span<const float> nodes, const Value& value, const Cdf& cdf, float u) {
    const int n = int(nodes.size());
    u *= cdf(n - 1);
    int low = 0, high = n - 1;
    while (high - low > 1) {
        const int middle = (low + high) / 2;
        (cdf(middle) <= u ? low : high) = middle;
    }
    const float x0 = nodes[low], x1 = nodes[low + 1], width = x1 - x0;
    const float f0 = value(low), f1 = value(low + 1);
    const float d0 = low > 0 ? width * (f1 - value(low - 1)) / (x1 - nodes[low - 1]) : f1 - f0;
    const float d1 = low + 2 < n ? width * (value(low + 2) - f0) / (nodes[low + 2] - x0) : f1 - f0;
    const float target = (u - cdf(low)) / width;
    float a = 0, b = 1, t = 0.5f;
    for (int step = 0; step < 50; ++step) {
        const float integral =
            t * (f0 + t * (0.5f * d0 + t * ((-2 * d0 - d1) / 3 + f1 - f0 +
                                            t * (0.25f * (d0 + d1) + 0.5f * (f0 - f1)))));
        const float f =
            f0 + t * (d0 + t * (-2 * d0 - d1 + 3 * (f1 - f0) + t * (d0 + d1 + 2 * (f0 - f1))));
        if (std::abs(integral - target) < 1e-6f || b - a < 1e-6f) break;
        (integral < target ? a : b) = t;
        t -= (integral - target) / f;
        if (!(t > a && t < b)) t = 0.5f * (a + b);
    }
    return x0 + t * width;
}

}  // namespace lull
