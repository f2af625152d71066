// Compares samples on the sphere with their density: random numbers, grids, integrals and the
// chi-square test.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "renderer/base/sampling.h"

namespace lull::test {

// Generates uniform numbers in [0, 1) from a seed (Steele, Lea, Flood 2014).
class Random {
  public:
    explicit Random(uint64_t seed) : state(seed) {}

    float Float() { return float(Bits() >> 40) * 0x1p-24f; }
    Vec2f Point() {
        const float x = Float();
        return {x, Float()};
    }
    int Below(int n) { return int(Bits() % uint64_t(n)); }
    Vec3f Direction() { return SampleUniformSphere(Point()).normalized(); }

  private:
    uint64_t Bits() {
        uint64_t z = (state += 0x9e3779b97f4a7c15ull);
        z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
        z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
        return z ^ (z >> 31);
    }
    uint64_t state;
};

// Returns the unit vector `degrees` from +z, at `azimuth` degrees from +x.
inline Vec3f FromAngles(double degrees, double azimuth = 0) {
    const double t = degrees * std::numbers::pi / 180, p = azimuth * std::numbers::pi / 180;
    return Eigen::Vector3d(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p), std::cos(t))
        .cast<float>();
}

// Represents a polar grid on the sphere: cells lie between consecutive angles `theta` (radians,
// from frame.n, first 0, last pi). A peak should be at the axis, a jump along an edge.
struct SphereGrid {
    Frame frame;
    std::vector<double> theta;
    int azimuths;

    int CellCount() const { return int(theta.size() - 1) * azimuths; }
    int CellOf(const Vec3f& w) const {
        const Vec3f v = frame.ToLocal(w);
        const double t = std::atan2(std::hypot(v.x(), v.y()), v.z());
        double p = std::atan2(v.y(), v.x());
        if (p < 0) p += 2 * std::numbers::pi;
        const int ring = int(std::upper_bound(theta.begin(), theta.end(), t) - theta.begin()) - 1;
        return std::clamp(ring, 0, int(theta.size()) - 2) * azimuths +
               std::min(int(p / (2 * std::numbers::pi) * azimuths), azimuths - 1);
    }
};

// Makes a grid around +z that has the equator as an edge; `rings` is even.
inline SphereGrid EvenGrid(int rings, int azimuths) {
    SphereGrid grid{{Vec3f::UnitX(), Vec3f::UnitY(), Vec3f::UnitZ()}, {}, azimuths};
    for (int i = 0; i <= rings; ++i)
        grid.theta.push_back(std::acos(std::clamp(1 - 2.0 * i / rings, -1.0, 1.0)));
    return grid;
}

// Makes a grid around `peak` whose rings grow geometrically from `smallest` radians to pi.
inline SphereGrid PeakedGrid(const Vec3f& peak, double smallest, int rings, int azimuths) {
    SphereGrid grid{{{}, {}, peak}, {0}, azimuths};
    CoordinateSystem(peak, &grid.frame.s, &grid.frame.t);
    for (int i = 0; i < rings; ++i)
        grid.theta.push_back(smallest *
                             std::pow(std::numbers::pi / smallest, i / double(rings - 1)));
    return grid;
}

using SphereFunction = std::function<double(const Vec3f&)>;

// Integrates f over a part of the grid's (theta, phi) domain: nine points of Gauss and Legendre,
// and four parts in turn until these agree with the whole or `depth` is used up.
inline double IntegratePart(const SphereGrid& grid, const SphereFunction& f, double t0, double t1,
                            double p0, double p1, double tolerance, int depth) {
    const auto rule = [&](double a0, double a1, double b0, double b1) {
        constexpr double node[] = {-0.7745966692414834, 0, 0.7745966692414834};
        constexpr double weight[] = {5 / 18.0, 8 / 18.0, 5 / 18.0};
        double sum = 0;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const double t = (a0 + a1 + node[i] * (a1 - a0)) / 2;
                const double p = (b0 + b1 + node[j] * (b1 - b0)) / 2;
                const Eigen::Vector3d v(std::sin(t) * std::cos(p), std::sin(t) * std::sin(p),
                                        std::cos(t));
                const Eigen::Vector3d w = grid.frame.s.cast<double>() * v.x() +
                                          grid.frame.t.cast<double>() * v.y() +
                                          grid.frame.n.cast<double>() * v.z();
                sum += weight[i] * weight[j] * std::sin(t) * f(w.normalized().cast<float>());
            }
        return sum * (a1 - a0) * (b1 - b0);
    };
    const double tm = (t0 + t1) / 2, pm = (p0 + p1) / 2;
    const double whole = rule(t0, t1, p0, p1);
    const double parts =
        rule(t0, tm, p0, pm) + rule(tm, t1, p0, pm) + rule(t0, tm, pm, p1) + rule(tm, t1, pm, p1);
    if (depth == 0 || std::abs(parts - whole) < tolerance) return parts;
    return IntegratePart(grid, f, t0, tm, p0, pm, tolerance / 2, depth - 1) +
           IntegratePart(grid, f, tm, t1, p0, pm, tolerance / 2, depth - 1) +
           IntegratePart(grid, f, t0, tm, pm, p1, tolerance / 2, depth - 1) +
           IntegratePart(grid, f, tm, t1, pm, p1, tolerance / 2, depth - 1);
}

// Integrates f over each cell.
inline std::vector<double> Integrate(const SphereGrid& grid, const SphereFunction& f,
                                     double tolerance = 2e-6, int depth = 6) {
    std::vector<double> cells;
    const double step = 2 * std::numbers::pi / grid.azimuths;
    for (size_t ring = 0; ring + 1 < grid.theta.size(); ++ring)
        for (int i = 0; i < grid.azimuths; ++i)
            cells.push_back(IntegratePart(grid, f, grid.theta[ring], grid.theta[ring + 1], i * step,
                                          (i + 1) * step, tolerance, depth));
    return cells;
}

// Returns the regularised upper incomplete gamma function Q(a, x) (series below a + 1, Lentz'
// continued fraction above).
inline double UpperGamma(double a, double x) {
    if (!(x > 0)) return 1;
    const double front = std::exp(a * std::log(x) - x - std::lgamma(a));
    if (x < a + 1) {
        double term = 1 / a, sum = term;
        for (int n = 1; term > sum * 1e-15; ++n) sum += term *= x / (a + n);
        return 1 - front * sum;
    }
    double b = x + 1 - a, c = 1e300, d = 1 / b, h = d;
    for (int n = 1; n < 10000; ++n) {
        const double an = -n * (n - a);
        b += 2;
        d = 1 / (an * d + b);
        c = b + an / c;
        h *= c * d;
        if (std::abs(c * d - 1) < 1e-14) break;
    }
    return front * h;
}

// Returns the probability that samples deviate from `expected` (probabilities by cell; the rest to
// 1 belongs to refused samples) at least as much as `observed` does (Pearson 1900). Cells that
// expect fewer than 5 samples are pooled.
inline double ChiSquarePValue(const std::vector<double>& expected,
                              const std::vector<int64_t>& observed, int64_t sampleCount) {
    double statistic = 0, pooledExpected = 0, missing = 1;
    int64_t pooledObserved = 0, refused = sampleCount;
    int terms = 0;
    const auto add = [&](double e, int64_t o) {
        if (e >= 5) {
            statistic += Sqr(o - e) / e;
            ++terms;
        } else {
            pooledExpected += e;
            pooledObserved += o;
        }
    };
    for (size_t i = 0; i < expected.size(); ++i) {
        add(expected[i] * sampleCount, observed[i]);
        missing -= expected[i];
        refused -= observed[i];
    }
    add(std::max(0.0, missing) * sampleCount, refused);
    if (pooledExpected >= 5) {
        statistic += Sqr(pooledObserved - pooledExpected) / pooledExpected;
        ++terms;
    } else if (pooledObserved > 25) {
        return 0;  // samples where there should be next to none
    }
    return terms > 1 ? UpperGamma((terms - 1) / 2.0, statistic / 2) : 1;
}

// Returns the p-value of `count` directions, which sample(random) returns (nothing: refused),
// against the integrals of their density; `total` receives the integral over all.
template <typename Sample>
double PValueOf(const SphereGrid& grid, const SphereFunction& density, int count, uint64_t seed,
                const Sample& sample, double* total) {
    const std::vector<double> expected = Integrate(grid, density);
    *total = 0;
    for (const double e : expected) *total += e;
    Random random(seed);
    std::vector<int64_t> observed(expected.size());
    for (int i = 0; i < count; ++i)
        if (const std::optional<Vec3f> w = sample(random)) ++observed[size_t(grid.CellOf(*w))];
    return ChiSquarePValue(expected, observed, count);
}

// Takes the mean of numbers, with its standard error.
struct SampleMean {
    double sum = 0, squares = 0;
    int count = 0;

    void Add(double v) {
        sum += v;
        squares += v * v;
        ++count;
    }
    double Value() const { return sum / count; }
    double Variance() const { return std::max(0.0, squares / count - Sqr(Value())); }
    double Error() const { return std::sqrt(Variance() / count); }
};

// Returns the significance of each of n tests that gives the whole family 0.001 (Sidak 1967).
inline double Significance(int n) { return 1 - std::pow(1 - 0.001, 1.0 / n); }

}  // namespace lull::test
