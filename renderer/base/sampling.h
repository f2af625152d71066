// Turns uniform numbers into directions, points and choices.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "renderer/base/math.h"

namespace lull {

struct SineCosine {
    float sine, cosine;
};

// Takes an angle in [-pi/4, pi/4]; errors are below 1e-7 (polynomials of Cephes, Moshier 1989).
inline SineCosine SineCosineOf(float angle) {
    const float z = Sqr(angle);
    const float s = (-1.9515295891e-4f * z + 8.3321608736e-3f) * z - 1.6666654611e-1f;
    const float c = (2.443315711809948e-5f * z - 1.388731625493765e-3f) * z + 4.166664568298827e-2f;
    return {angle + angle * z * s, 1 - 0.5f * z + Sqr(z) * c};
}

// Returns sine and cosine of 2 pi u, u in [0, 1].
inline SineCosine SineCosineOfTurn(float u) {
    const int quarter = int(4 * u + 0.5f);
    const SineCosine in = SineCosineOf((4 * u - float(quarter)) * (kPi / 2));
    const bool isOdd = quarter & 1;
    const float s = isOdd ? in.cosine : in.sine, c = isOdd ? in.sine : in.cosine;
    return {quarter & 2 ? -s : s, (quarter + 1) & 2 ? -c : c};
}

// Maps the unit square to the unit disk, area-preserving (Shirley and Chiu 1997).
inline Vec2f SampleConcentricDisk(const Vec2f& u) {
    const float x = 2 * u.x() - 1, y = 2 * u.y() - 1;
    const bool isWide = std::abs(x) > std::abs(y);
    const float r = isWide ? x : y, other = isWide ? y : x;
    if (r == 0) [[unlikely]]
        return Vec2f::Zero();
    const auto [s, c] = SineCosineOf(kPi / 4 * (other / r));
    return r * (isWide ? Vec2f(c, s) : Vec2f(s, c));
}

// Maps the unit square to directions up to this sine from +z; density: cos(theta) / (pi sine^2).
inline Vec3f SampleCosineHemisphere(const Vec2f& u, float sine = 1) {
    const Vec2f d = sine * SampleConcentricDisk(u);
    return {d.x(), d.y(), SafeSqrt(1 - d.squaredNorm())};
}

// Maps the unit square uniformly to the unit sphere.
inline Vec3f SampleUniformSphere(const Vec2f& u) {
    const float z = 1 - 2 * u.x();
    const float r = SafeSqrt(1 - z * z);
    const auto [s, c] = SineCosineOfTurn(u.y());
    return {r * c, r * s, z};
}

// Maps the unit square uniformly to a triangle; returns the barycentrics (b0, b1).
inline Vec2f SampleUniformTriangle(const Vec2f& u) {
    const float s = std::sqrt(u.x());
    return {1 - s, u.y() * s};
}

// Weighs a sample taken with density f against a rival density g (Veach 1997, eq. 9.16, beta 2).
// Computed from the ratio, so that no square overflows.
inline float PowerHeuristic(float f, float g) {
    if (!(f > 0)) return 0;
    const float r = g / f;
    return 1 / (1 + r * r);
}

// Returns the index-th element of the van der Corput sequence in `base`, in [0, 1).
float RadicalInverse(int base, uint64_t index);

// Refers to the tables of a piecewise-constant density over [0, 1): the running sums of the
// probabilities of `count` elements, from 0 to 1, and a guide to them.
struct DistributionTables {
    // A guide entry stands for this many elements: a scan stays within a cache line or two.
    static constexpr int kGuideStep = 4;

    const float* cdf;  // count + 1
    const int* guide;  // EntriesFor(count): where to begin for u = k / entries
    int count;

    static int EntriesFor(int count) { return (count + kGuideStep - 1) / kGuideStep; }
    float Pmf(int i) const { return cdf[i + 1] - cdf[i]; }
    // Returns where the search for u begins, which is rarely far from where it ends.
    int Begin(float u) const {
        const int entries = EntriesFor(count);
        return guide[std::min(int(u * float(entries)), entries - 1)];
    }
    // Returns the i with cdf[i] <= u < cdf[i + 1], from Begin(u) onwards (Chen and Asau 1974).
    int FindFrom(int begin, float u) const {
        int i = begin;
        while (cdf[i + 1] <= u && i < count - 1) ++i;
        return i;
    }
    // Returns the place in element i of u, which lies there, both in [0, 1).
    float PlaceIn(int i, float u) const {
        const float width = Pmf(i);
        return width > 0 ? std::clamp((u - cdf[i]) / width, 0.f, kOneMinusEpsilon) : 0.5f;
    }
};

// Represents a piecewise-constant density over [0, 1), proportional to nonnegative values. All-zero
// (or non-finite) values give the uniform density. Only running sums are stored; all probabilities
// are their differences, consistent with Sample().
class Distribution1D {
  public:
    Distribution1D() = default;
    explicit Distribution1D(std::span<const float> values);

    int Count() const { return int(cdf.size()) - 1; }
    float Integral() const { return integral; }
    float Pmf(int i) const { return cdf[i + 1] - cdf[i]; }
    // Returns the density at x in [0, 1).
    float Pdf(float x) const { return Pmf(std::clamp(int(x * Count()), 0, Count() - 1)) * Count(); }
    // Chooses an element; `pmf` receives its probability, > 0 for every choice that can occur.
    int SampleDiscrete(float u, float* pmf) const {
        const int i = Find(u);
        *pmf = Pmf(i);
        return i;
    }
    // Chooses a place in [0, 1); `pdf` receives the density, `offset` the element it lies in.
    float SampleContinuous(float u, float* pdf, int* offset) const {
        *offset = Find(u);
        *pdf = Pmf(*offset) * Count();
        const float place = Tables().PlaceIn(*offset, u);
        return std::min((*offset + place) / Count(), kOneMinusEpsilon);
    }
    DistributionTables Tables() const { return {cdf.data(), guide.data(), Count()}; }

  private:
    int Find(float u) const {
        const DistributionTables tables = Tables();
        return tables.FindFrom(tables.Begin(u), u);
    }

    std::vector<float> cdf;
    std::vector<int> guide;
    float integral = 0;
};

// Represents a choice among the elements of a table, row-major. The tables of all rows lie one
// after another, so that their place follows from the row alone.
class Distribution2D {
  public:
    Distribution2D() = default;
    Distribution2D(std::span<const float> values, int columns, int rows);

    int Columns() const { return columns; }
    // Chooses an element (column, row); `u` in the unit square becomes the place in it.
    Vec2i SampleDiscrete(Vec2f* u, float* pmf) const {
        const DistributionTables down = marginal.Tables();
        const int row = down.FindFrom(down.Begin(u->y()), u->y());
        const DistributionTables across = Row(row);
        const int column = across.FindFrom(across.Begin(u->x()), u->x());
        *pmf = down.Pmf(row) * across.Pmf(column);
        *u = {across.PlaceIn(column, u->x()), down.PlaceIn(row, u->y())};
        return {column, row};
    }
    float Pmf(const Vec2i& at) const { return marginal.Pmf(at.y()) * Row(at.y()).Pmf(at.x()); }

  private:
    DistributionTables Row(int row) const {
        return {cdfs.data() + size_t(row) * size_t(columns + 1),
                guides.data() + size_t(row) * size_t(entries), columns};
    }

    int columns = 0, entries = 0;  // of a row
    std::vector<float> cdfs;       // rows of columns + 1
    std::vector<int> guides;       // rows of `entries`
    Distribution1D marginal;
};

// Interpolates by Catmull-Rom splines through unevenly spaced nodes, and samples by them.

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
    // Slopes are differences of the neighbours, one-sided at the first and last node.
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

// Maps the sphere to the unit square so that equal areas stay equal: an octahedron whose lower
// faces are folded outwards (Clarberg 2008, "Fast Equal-Area Mapping of the (Hemi)Sphere using
// SIMD"), in the orientation of pbrt-v4: +z in the middle, -z in the corners.

// Returns the direction of a point of the unit square; unit.
inline Vec3f DirectionOfEqualAreaSquare(const Vec2f& p) {
    const float u = 2 * p.x() - 1, v = 2 * p.y() - 1;
    const float signedDistance = 1 - (std::abs(u) + std::abs(v));
    const float r = 1 - std::abs(signedDistance);
    const float phi = (r == 0 ? 1 : (std::abs(v) - std::abs(u)) / r + 1) * (kPi / 4);
    const float z = std::copysign(1 - Sqr(r), signedDistance);
    const float across = r * SafeSqrt(2 - Sqr(r));
    return {std::copysign(std::cos(phi) * across, u), std::copysign(std::sin(phi) * across, v), z};
}

// Returns the point of the unit square of a unit direction.
inline Vec2f EqualAreaSquareOf(const Vec3f& w) {
    const float x = std::abs(w.x()), y = std::abs(w.y());
    const float r = SafeSqrt(1 - std::abs(w.z()));
    float v = r * (std::max(x, y) > 0 ? std::atan2(y, x) : 0) * (2 / kPi), u = r - v;
    if (w.z() < 0) {
        std::swap(u, v);
        u = 1 - u;
        v = 1 - v;
    }
    return {0.5f * (std::copysign(u, w.x()) + 1), 0.5f * (std::copysign(v, w.y()) + 1)};
}

// Samples the unit square by a large table, of which little has to be in the caches.

// Represents a density over the unit square that is constant over each of columns x rows cells.
// Blocks of cells are chosen by a small table. Where the weights of a block's cells differ, so that
// it matters, the block has a table of its cells; else it is sampled evenly.
class BlockDistribution {
  public:
    static constexpr int kSide = 16;  // of a block, in cells

    // Writes the weights of a row of cells, >= 0, whose sum is finite. Called again for some rows.
    using Weigh = std::function<void(int row, std::span<float> weights)>;

    BlockDistribution() = default;
    // The density is proportional to the weights, but for blocks that are sampled evenly. These
    // add at most `tolerance` to the relative variance of weight / density: with 0 it is exact.
    BlockDistribution(int columns, int rows, const Weigh& weigh, float tolerance);

    // Returns a point of the unit square, and the density there: 0 if all weights are 0.
    Vec2f Sample(const Vec2f& u, float* pdf) const {
        Vec2f place = u;
        float pmf;
        const Vec2i block = blocks.SampleDiscrete(&place, &pmf);
        *pdf = scale;
        Vec2f cell = kSide * (block.cast<float>() + place);
        if (const int32_t table = TableOf(block); table >= 0) {
            const Cells& in = cells[table];
            const int row = Choose(in.rows, &place.y(), pdf);
            const int column = Choose(in.columns[row], &place.x(), pdf);
            *pdf *= kSide * kSide;
            cell = (kSide * block + Vec2i(column, row)).cast<float>() + place;
        }
        *pdf *= pmf;
        return {std::min(cell.x() / float(columns), kOneMinusEpsilon),
                std::min(cell.y() / float(rows), kOneMinusEpsilon)};
    }
    // Returns the density at a point of the unit square.
    float Pdf(const Vec2f& st) const {
        const int column = std::clamp(int(st.x() * float(columns)), 0, columns - 1);
        const int row = std::clamp(int(st.y() * float(rows)), 0, rows - 1);
        const Vec2i block(column / kSide, row / kSide);
        const int32_t table = TableOf(block);
        if (table < 0) return scale * blocks.Pmf(block);
        const Cells& in = cells[table];
        return scale * (kSide * kSide) * Pmf(in.rows, row % kSide) *
               Pmf(in.columns[row % kSide], column % kSide) * blocks.Pmf(block);
    }

  private:
    // Running sums of probabilities, up to and with each element; the last is 1.
    using Sums = std::array<float, kSide>;

    // The rows of a block, and the cells of each row: two cache lines are read.
    struct alignas(64) Cells {
        Sums rows;
        std::array<Sums, kSide> columns;
    };

    int32_t TableOf(const Vec2i& block) const {
        return tables[size_t(block.y()) * size_t(blocks.Columns()) + block.x()];
    }
    static float Pmf(const Sums& sums, int i) { return i == 0 ? sums[0] : sums[i] - sums[i - 1]; }
    // `u` in [0, 1) becomes the place in the element, and `pmf` is multiplied by its probability.
    static int Choose(const Sums& sums, float* u, float* pmf) {
        int i = 0;
        for (int k = 0; k < kSide - 1; ++k) i += sums[k] <= *u;
        const float below = i == 0 ? 0 : sums[i - 1];
        const float width = sums[i] - below;
        *u = std::min((*u - below) / width, kOneMinusEpsilon);
        *pmf *= width;
        return i;
    }
    static Sums SumsOf(const Sums& weights);
    static Cells MakeCells(const float* weights, int stride);

    int columns = 1, rows = 1;  // without the padding of the last blocks
    float scale = 0;            // density of a block that is as likely as all together
    Distribution2D blocks;
    std::vector<int32_t> tables;  // by block, row by row; -1: sampled evenly
    std::vector<Cells> cells;
};

}  // namespace lull
