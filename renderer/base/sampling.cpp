#include "renderer/base/sampling.h"

#include <numeric>

namespace lull {

Vec2f SampleConcentricDisk(const Vec2f& u) {
    const Vec2f o = 2 * u - Vec2f::Ones();
    if (o.x() == 0 && o.y() == 0) return Vec2f::Zero();
    if (std::abs(o.x()) > std::abs(o.y())) {
        const float theta = kPi / 4 * (o.y() / o.x());
        return o.x() * Vec2f(std::cos(theta), std::sin(theta));
    }
    const float theta = kPi / 2 - kPi / 4 * (o.x() / o.y());
    return o.y() * Vec2f(std::cos(theta), std::sin(theta));
}

Vec3f SampleUniformSphere(const Vec2f& u) {
    const float z = 1 - 2 * u.x();
    const float r = SafeSqrt(1 - z * z);
    const float phi = 2 * kPi * u.y();
    return {r * std::cos(phi), r * std::sin(phi), z};
}

float RadicalInverse(int base, uint64_t index) {
    const double inverseBase = 1.0 / base;
    double digitWeight = inverseBase, result = 0;
    for (; index > 0; index /= base, digitWeight *= inverseBase)
        result += double(index % base) * digitWeight;
    return std::min(float(result), kOneMinusEpsilon);
}

Distribution1D::Distribution1D(std::span<const float> given)
    : values(given.begin(), given.end()), cdf(given.size() + 1) {
    const double sum = std::accumulate(values.begin(), values.end(), 0.0);
    if (!(sum > 0) || !std::isfinite(sum)) {
        std::fill(values.begin(), values.end(), 1.f);
        pmfScale = 1.f / values.size();
    } else {
        integral = float(sum / values.size());
        pmfScale = float(1 / sum);
    }
    // Sum in double, so that long tables keep their small entries.
    double running = 0;
    const double total = std::accumulate(values.begin(), values.end(), 0.0);
    for (size_t i = 0; i < values.size(); ++i) {
        cdf[i] = float(running / total);
        running += values[i];
    }
    cdf.back() = 1;
}

// Returns the last i with cdf[i] <= u and a positive value.
int Distribution1D::Find(float u) const {
    const auto it = std::upper_bound(cdf.begin(), cdf.end(), u);
    int i = std::clamp(int(it - cdf.begin()) - 1, 0, Count() - 1);
    // Rounding can make a tiny value's interval empty; step to a neighbour that can be chosen.
    while (values[i] == 0 && i > 0) --i;
    while (values[i] == 0 && i < Count() - 1) ++i;
    return i;
}

int Distribution1D::SampleDiscrete(float u, float* pmf) const {
    const int i = Find(u);
    *pmf = Pmf(i);
    return i;
}

float Distribution1D::SampleContinuous(float u, float* pdf, int* offset) const {
    const int i = Find(u);
    *offset = i;
    *pdf = Pmf(i) * Count();
    const float width = cdf[i + 1] - cdf[i];
    const float t = width > 0 ? std::clamp((u - cdf[i]) / width, 0.f, kOneMinusEpsilon) : 0.5f;
    return std::min((i + t) / Count(), kOneMinusEpsilon);
}

Distribution2D::Distribution2D(std::span<const float> values, int nu, int nv) {
    std::vector<float> rowIntegrals;
    for (int v = 0; v < nv; ++v) {
        conditional.emplace_back(values.subspan(size_t(v) * nu, nu));
        rowIntegrals.push_back(conditional.back().Integral());
    }
    marginal = Distribution1D(rowIntegrals);
}

Vec2f Distribution2D::SampleContinuous(const Vec2f& u, float* pdf) const {
    float pdfU, pdfV;
    int row, column;
    const float v = marginal.SampleContinuous(u.y(), &pdfV, &row);
    const float x = conditional[row].SampleContinuous(u.x(), &pdfU, &column);
    *pdf = pdfU * pdfV;
    return {x, v};
}

float Distribution2D::Pdf(const Vec2f& p) const {
    const int row = std::clamp(int(p.y() * marginal.Count()), 0, marginal.Count() - 1);
    return marginal.Pdf(p.y()) * conditional[row].Pdf(p.x());
}

}  // namespace lull
