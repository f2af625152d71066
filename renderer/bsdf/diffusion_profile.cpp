#include "renderer/bsdf/diffusion_profile.h"

#include "renderer/base/spline.h"
#include "renderer/bsdf/fresnel.h"
#include "renderer/bsdf/fresnel_moments.h"
#include "renderer/bsdf/phase.h"

namespace lull {
namespace {

constexpr double kInv4Pi = 0.25 * std::numbers::inv_pi;
constexpr int kDepths = 100;  // of the beam, by the exponential of its extinction

double DepthOf(int sample) { return -std::log(1 - (sample + 0.5) / kDepths); }

// Radiant exitance at distance r after many scatterings: a dipole for each depth at which light may
// have become diffuse (eq. 15.24 to 15.32). `sigmaS` + `sigmaA` is 1.
double MultipleScattering(double sigmaS, double sigmaA, double g, double eta, double r) {
    const double reducedS = sigmaS * (1 - g), reducedT = sigmaA + reducedS;
    const double albedo = reducedS / reducedT;
    // Grosjean's diffusion coefficient, and the extrapolated boundary.
    const double diffusion = (2 * sigmaA + reducedS) / (3 * Sqr(reducedT));
    const double transport = std::sqrt(sigmaA / diffusion);
    const double m1 = FresnelMoment1(eta), m2 = FresnelMoment2(eta);
    const double boundary = -2 * diffusion * (1 + 3 * m2) / (1 - 2 * m1);
    const double ofFluence = 0.25 * (1 - 2 * m1), ofIrradiance = 0.5 * (1 - 3 * m2);
    double sum = 0;
    for (int i = 0; i < kDepths; ++i) {
        const double real = DepthOf(i) / reducedT, mirrored = 2 * boundary - real;
        const double dr = std::hypot(r, real), dv = std::hypot(r, mirrored);
        const double er = std::exp(-transport * dr), ev = std::exp(-transport * dv);
        const double fluence = kInv4Pi / diffusion * (er / dr - ev / dv);
        const double irradiance = kInv4Pi * (real * (1 + transport * dr) * er / (dr * dr * dr) -
                                             mirrored * (1 + transport * dv) * ev / (dv * dv * dv));
        const double nearby = 1 - std::exp(-2 * reducedT * (dr + real));
        sum += nearby * Sqr(albedo) * (fluence * ofFluence + irradiance * ofIrradiance);
    }
    return sum / kDepths;
}

// Radiant exitance at distance r after one scattering, at the depths from where it is not reflected
// totally (15.5.4).
double SingleScattering(double sigmaS, double g, double eta, double r) {
    const double least = r * std::sqrt(Sqr(eta) - 1);
    double sum = 0;
    for (int i = 0; i < kDepths; ++i) {
        const double depth = least + DepthOf(i);
        const double d = std::hypot(r, depth), cosine = depth / d;
        sum += sigmaS * std::exp(-(d + least)) / Sqr(d) *
               double(PhaseHenyeyGreenstein(float(cosine), float(g))) *
               double(1 - FresnelDielectric(float(-cosine), float(eta))) * cosine;
    }
    return sum / kDepths;
}

// Integrates the spline through the values up to each node.
void Integrate(std::span<const float> x, std::span<const float> f, std::span<float> cdf) {
    const int n = int(x.size());
    cdf[0] = 0;
    double sum = 0;
    for (int i = 0; i + 1 < n; ++i) {
        const double width = x[i + 1] - x[i], f0 = f[i], f1 = f[i + 1];
        const double d0 = i > 0 ? width * (f1 - f[i - 1]) / (x[i + 1] - x[i - 1]) : f1 - f0;
        const double d1 = i + 2 < n ? width * (f[i + 2] - f0) / (x[i + 2] - x[i]) : f1 - f0;
        sum += ((d0 - d1) / 12 + (f0 + f1) / 2) * width;
        cdf[i + 1] = float(sum);
    }
}

}  // namespace

DiffusionTable::DiffusionTable(float g, float eta)
    : profile(kAlbedos * kRadii), cdf(kAlbedos * kRadii) {
    radius[0] = 0;
    radius[1] = 2.5e-3f;
    for (int i = 2; i < kRadii; ++i) radius[i] = 1.2f * radius[i - 1];
    for (int i = 0; i < kAlbedos; ++i) {
        const double a = (1 - std::exp(-8. * i / (kAlbedos - 1))) / (1 - std::exp(-8.));
        albedo[i] = float(a);
        float* const row = &profile[size_t(i) * kRadii];
        for (int j = 0; j < kRadii; ++j) {
            const double r = radius[j];
            row[j] =
                float(2 * std::numbers::pi * r *
                      (SingleScattering(a, g, eta, r) + MultipleScattering(a, 1 - a, g, eta, r)));
        }
        const std::span<float> integral(&cdf[size_t(i) * kRadii], kRadii);
        Integrate(radius, {row, kRadii}, integral);
        effectiveAlbedo[i] = integral.back();
    }
}

DiffusionProfile::DiffusionProfile(const DiffusionTable& table, const Rgb& sigmaA,
                                   const Rgb& sigmaS)
    : table(&table), sigmaT(sigmaA + sigmaS) {
    for (int c = 0; c < 3; ++c) albedo[c] = sigmaT[c] > 0 ? sigmaS[c] / sigmaT[c] : 0;
}

namespace {

// Interpolates the table's profile, without its factor 2 pi r, at the row's weights.
float ValueAt(const DiffusionTable& table, const SplineWeights& row, float radius) {
    const auto column = WeightsAt(table.radius, radius);
    if (!column) return 0;
    float sum = 0;
    for (int j = 0; j < 4; ++j)
        if (column->w[j] != 0)
            sum +=
                column->w[j] * BetweenRows(
                                   row,
                                   [&](int a, int r) {
                                       return table.profile[size_t(a) * DiffusionTable::kRadii + r];
                                   },
                                   column->first + j);
    return radius > 0 ? sum / (2 * kPi * radius) : sum;
}

}  // namespace

Rgb DiffusionProfile::operator()(float r) const {
    Rgb value = Rgb::Zero();
    for (int c = 0; c < 3; ++c)
        if (const auto row = WeightsAt(table->albedo, albedo[c]))
            value[c] = ValueAt(*table, *row, r * sigmaT[c]);
    return (value * sigmaT.square()).max(0.f);
}

std::optional<float> DiffusionProfile::Sample(int channel, float u) const {
    const auto row = WeightsAt(table->albedo, albedo[channel]);
    if (!row || !(albedo[channel] > 0)) return {};
    const auto entry = [&](const std::vector<float>& values) {
        return [&values, &row](int i) {
            return BetweenRows(
                *row, [&](int a, int k) { return values[size_t(a) * DiffusionTable::kRadii + k]; },
                i);
        };
    };
    return SampleSpline(table->radius, entry(table->profile), entry(table->cdf), u) /
           sigmaT[channel];
}

float DiffusionProfile::Pdf(int channel, float r) const {
    const auto row = WeightsAt(table->albedo, albedo[channel]);
    if (!row || !(albedo[channel] > 0)) return 0;
    float effective = 0;
    for (int b = 0; b < 4; ++b)
        if (row->w[b] != 0) effective += row->w[b] * table->effectiveAlbedo[row->first + b];
    const float pdf = ValueAt(*table, *row, r * sigmaT[channel]) * Sqr(sigmaT[channel]) / effective;
    return pdf > 0 && pdf < kInfinity ? pdf : 0;
}

namespace {

// The profile has a pole at 0, which is left out.
constexpr float kLeastRadius = 1e-6f;

}  // namespace

Rgb BurleyProfile::operator()(float r) const {
    r = std::max(r, kLeastRadius);
    const Rgb x = -r / distance;
    const Rgb value = albedo * (x.exp() + (x / 3).exp()) / (8 * kPi * r * distance);
    return (distance > 0).select(value, 0.f);
}

// A quarter of the integral is the first exponential's.
std::optional<float> BurleyProfile::Sample(int channel, float u) const {
    if (!(distance[channel] > 0)) return {};
    const bool isFirst = u < 0.25f;
    const float v = std::min(isFirst ? 4 * u : (u - 0.25f) / 0.75f, kOneMinusEpsilon);
    return -(isFirst ? 1 : 3) * distance[channel] * std::log(1 - v);
}

float BurleyProfile::Pdf(int channel, float r) const {
    r = std::max(r, kLeastRadius);
    const float d = distance[channel];
    if (!(d > 0)) return 0;
    return (std::exp(-r / d) + std::exp(-r / (3 * d))) / (8 * kPi * d * r);
}

float AlbedoOfScattering(const DiffusionTable& table, float effective) {
    const auto& albedos = table.albedo;
    if (!(effective > table.effectiveAlbedo.front())) return albedos.front();
    if (!(effective < table.effectiveAlbedo.back())) return albedos.back();
    // The spline goes up, so halving finds where it passes.
    const int interval = IntervalOf(table.effectiveAlbedo, effective);
    float low = albedos[interval], high = albedos[interval + 1];
    for (int i = 0; i < 20; ++i) {
        const float middle = 0.5f * (low + high);
        const SplineWeights w = *WeightsAt(albedos, middle);
        float value = 0;
        for (int b = 0; b < 4; ++b)
            if (w.w[b] != 0) value += w.w[b] * table.effectiveAlbedo[w.first + b];
        (value < effective ? low : high) = middle;
    }
    return 0.5f * (low + high);
}

}  // namespace lull
