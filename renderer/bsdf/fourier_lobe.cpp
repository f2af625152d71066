#include "renderer/bsdf/fourier_lobe.h"

#include "renderer/base/sampling.h"

namespace lull {
namespace {

// Lists the series, up to 16, whose weighted sum the table has at a pair of cosines.
struct WeightedSeries {
    std::array<FourierTable::Series, 16> series;
    std::array<float, 16> weight;
    int count = 0, order = 0;

    WeightedSeries(const FourierTable& table, const SplineWeights& o, const SplineWeights& i) {
        for (int b = 0; b < 4; ++b)
            for (int a = 0; a < 4; ++a) {
                const float w = o.w[b] * i.w[a];
                if (w == 0) continue;
                const auto& s = table.series[size_t(o.first + b) * table.mu.size() + i.first + a];
                series[count] = s;
                weight[count++] = w;
                order = std::max(order, s.order);
            }
    }

    float Coefficient(const FourierTable& table, int channel, int k) const {
        float sum = 0;
        for (int e = 0; e < count; ++e)
            if (k < series[e].order)
                sum += weight[e] *
                       table.coefficients[series[e].first + size_t(channel) * series[e].order + k];
        return sum;
    }
};

float SampleCosine(const FourierTable& table, const SplineWeights& o, float u) {
    const int n = int(table.mu.size());
    const auto cdf = [&](int i) {
        return BetweenRows(
            o, [&](int row, int k) { return table.cdf[size_t(row) * n + k]; }, i);
    };
    const auto value = [&](int i) {
        return BetweenRows(
            o, [&](int row, int k) { return table.Mean(row, k); }, i);
    };
    return SampleSpline(table.mu, value, cdf, u);
}

double SampleAzimuth(std::span<const float> a, float u) {
    const bool flip = u >= 0.5f;
    const double target = double(flip ? 2 - 2 * u : 2 * u) * a[0] * std::numbers::pi;
    double low = 0, high = std::numbers::pi, phi = 0.5 * std::numbers::pi;
    for (int step = 0; step < 60; ++step) {
        // Cosines and sines of k phi follow from those of the two before.
        const double c = std::cos(phi), s = std::sin(phi);
        double cosBefore = c, cosNow = 1, sinBefore = -s, sinNow = 0;
        double integral = a[0] * phi - target, f = a[0];
        for (size_t k = 1; k < a.size(); ++k) {
            const double cosNext = 2 * c * cosNow - cosBefore, sinNext = 2 * c * sinNow - sinBefore;
            cosBefore = cosNow, cosNow = cosNext;
            sinBefore = sinNow, sinNow = sinNext;
            integral += a[k] / double(k) * sinNow;
            f += a[k] * cosNow;
        }
        (integral > 0 ? high : low) = phi;
        if (std::abs(integral) < 1e-6 || high - low < 1e-6) break;
        phi -= integral / f;
        if (!(phi > low && phi < high)) phi = 0.5 * (low + high);
    }
    return flip ? 2 * std::numbers::pi - phi : phi;
}

}  // namespace

BsdfValue FourierLobe::Evaluate(const Vec3f& wo, const Vec3f& wi) const {
    const FourierTable& table = *stored;
    const float muI = -wi.z(), muO = wo.z();
    const auto i = WeightsAt(table.mu, muI), o = WeightsAt(table.mu, muO);
    if (!i || !o || muI == 0) return {};
    const float lengths = wo.head<2>().norm() * wi.head<2>().norm();
    const double cosPhi =
        lengths > 0 ? std::clamp(-wo.head<2>().dot(wi.head<2>()) / lengths, -1.f, 1.f) : 1.f;
    const WeightedSeries sum(table, *o, *i);
    std::array<double, 3> values{};
    double before = cosPhi, now = 1;
    // Seen along the normal there is no azimuth, and only the mean over all counts.
    const int order = lengths > 0 ? sum.order : std::min(sum.order, 1);
    for (int k = 0; k < order; ++k) {
        for (int c = 0; c < table.channels; ++c) values[c] += sum.Coefficient(table, c, k) * now;
        const double next = 2 * cosPhi * now - before;
        before = now;
        now = next;
    }
    const auto y = float(std::max(0., values[0]));
    float scale = 1 / std::abs(muI);
    // Refracted radiance grows with the square of the index.
    if (muI * muO > 0) scale *= Sqr(muI > 0 ? 1 / table.eta : table.eta);
    Rgb f(y, y, y);
    if (table.channels == 3) {
        const auto red = float(values[1]), blue = float(values[2]);
        f = Rgb(red, 1.39829f * y - 0.100913f * blue - 0.297375f * red, blue).max(0.f);
    }
    const int n = int(table.mu.size());
    const float rho =
        2 * kPi *
        BetweenRows(
            *o, [&](int row, int k) { return table.cdf[size_t(row) * n + k]; }, n - 1);
    return {f * Rgb(r) * scale, rho > 0 ? y / rho : 0};
}

bool FourierLobe::Sample(const Vec3f& wo, const Vec2f& u, Vec3f* wi) const {
    const FourierTable& table = *stored;
    const auto o = WeightsAt(table.mu, wo.z());
    if (!o) return false;
    const float muI = SampleCosine(table, *o, u.y());
    const auto i = WeightsAt(table.mu, muI);
    if (!i) return false;
    const WeightedSeries sum(table, *o, *i);
    std::array<float, FourierTable::kMaxOrder> a;  // only the first are set
    for (int k = 0; k < sum.order; ++k) a[k] = sum.Coefficient(table, 0, k);
    if (sum.order == 0 || !(a[0] > 0)) return false;
    const float length = wo.head<2>().norm();
    const int order = length > 0 ? sum.order : 1;
    const double phi = SampleAzimuth({a.data(), size_t(order)}, u.x());
    const Vec2f across = length > 0 ? Vec2f(wo.head<2>() / length) : Vec2f(1, 0);
    const float s = SafeSqrt(1 - Sqr(muI));
    const auto cosPhi = float(std::cos(phi)), sinPhi = float(std::sin(phi));
    *wi = -Vec3f(s * (cosPhi * across.x() - sinPhi * across.y()),
                 s * (sinPhi * across.x() + cosPhi * across.y()), muI)
               .normalized();
    return true;
}

}  // namespace lull
