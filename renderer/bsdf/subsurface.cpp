#include "renderer/bsdf/subsurface.h"

#include "renderer/base/sampling.h"
#include "renderer/bsdf/fresnel.h"

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

// Radiant exitance at distance r after one scattering, at depths without total reflection (15.5.4).
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

// The profile has a pole at 0, which is left out.
constexpr float kLeastRadius = 1e-6f;

struct Preset {
    const char* name;
    float sigmaS[3], sigmaA[3];
};

constexpr Preset kPresets[] = {
    {"Apple", {2.29f, 2.39f, 1.97f}, {0.0030f, 0.0034f, 0.046f}},
    {"Chicken1", {0.15f, 0.21f, 0.38f}, {0.015f, 0.077f, 0.19f}},
    {"Chicken2", {0.19f, 0.25f, 0.32f}, {0.018f, 0.088f, 0.20f}},
    {"Cream", {7.38f, 5.47f, 3.15f}, {0.0002f, 0.0028f, 0.0163f}},
    {"Ketchup", {0.18f, 0.07f, 0.03f}, {0.061f, 0.97f, 1.45f}},
    {"Marble", {2.19f, 2.62f, 3.00f}, {0.0021f, 0.0041f, 0.0071f}},
    {"Potato", {0.68f, 0.70f, 0.55f}, {0.0024f, 0.0090f, 0.12f}},
    {"Skimmilk", {0.70f, 1.22f, 1.90f}, {0.0014f, 0.0025f, 0.0142f}},
    {"Skin1", {0.74f, 0.88f, 1.01f}, {0.032f, 0.17f, 0.48f}},
    {"Skin2", {1.09f, 1.59f, 1.79f}, {0.013f, 0.070f, 0.145f}},
    {"Spectralon", {11.6f, 20.4f, 14.9f}, {0.00f, 0.00f, 0.00f}},
    {"Wholemilk", {2.55f, 3.21f, 3.77f}, {0.0011f, 0.0024f, 0.014f}},
    {"Lowfat Milk", {0.89187f, 1.5136f, 2.532f}, {0.002875f, 0.00575f, 0.0115f}},
    {"Reduced Milk", {2.4858f, 3.1669f, 4.5214f}, {0.0025556f, 0.0051111f, 0.012778f}},
    {"Regular Milk", {4.5513f, 5.8294f, 7.136f}, {0.0015333f, 0.0046f, 0.019933f}},
    {"Espresso", {0.72378f, 0.84557f, 1.0247f}, {4.7984f, 6.5751f, 8.8493f}},
    {"Mint Mocha Coffee", {0.31602f, 0.38538f, 0.48131f}, {3.772f, 5.8228f, 7.82f}},
    {"Lowfat Soy Milk", {0.30576f, 0.34233f, 0.61664f}, {0.0014375f, 0.0071875f, 0.035937f}},
    {"Regular Soy Milk", {0.59223f, 0.73866f, 1.4693f}, {0.0019167f, 0.0095833f, 0.065167f}},
    {"Lowfat Chocolate Milk", {0.64925f, 0.83916f, 1.1057f}, {0.0115f, 0.0368f, 0.1564f}},
    {"Regular Chocolate Milk", {1.4585f, 2.1289f, 2.9527f}, {0.010063f, 0.043125f, 0.14375f}},
    {"Coke", {8.9053e-05f, 8.372e-05f, 0.f}, {0.10014f, 0.16503f, 0.2468f}},
    {"Pepsi", {6.1697e-05f, 4.2564e-05f, 0.f}, {0.091641f, 0.14158f, 0.20729f}},
    {"Sprite", {6.0306e-06f, 6.4139e-06f, 6.5504e-06f}, {0.001886f, 0.0018308f, 0.0020025f}},
    {"Gatorade", {0.0024574f, 0.003007f, 0.0037325f}, {0.024794f, 0.019289f, 0.008878f}},
    {"Chardonnay", {1.7982e-05f, 1.3758e-05f, 1.2023e-05f}, {0.010782f, 0.011855f, 0.023997f}},
    {"White Zinfandel", {1.7501e-05f, 1.9069e-05f, 1.288e-05f}, {0.012072f, 0.016184f, 0.019843f}},
    {"Merlot", {2.1129e-05f, 0.f, 0.f}, {0.11632f, 0.25191f, 0.29434f}},
    {"Budweiser Beer", {2.4356e-05f, 2.4079e-05f, 1.0564e-05f}, {0.011492f, 0.024911f, 0.057786f}},
    {"Coors Light Beer", {5.0922e-05f, 4.301e-05f, 0.f}, {0.006164f, 0.013984f, 0.034983f}},
    {"Clorox", {0.0024035f, 0.0031373f, 0.003991f}, {0.0033542f, 0.014892f, 0.026297f}},
    {"Apple Juice", {0.00013612f, 0.00015836f, 0.000227f}, {0.012957f, 0.023741f, 0.052184f}},
    {"Cranberry Juice", {0.00010402f, 0.00011646f, 7.8139e-05f}, {0.039437f, 0.094223f, 0.12426f}},
    {"Grape Juice", {5.382e-05f, 0.f, 0.f}, {0.10404f, 0.23958f, 0.29325f}},
    {"Ruby Grapefruit Juice", {0.011002f, 0.010927f, 0.011036f}, {0.085867f, 0.18314f, 0.25262f}},
    {"White Grapefruit Juice", {0.22826f, 0.23998f, 0.32748f}, {0.0138f, 0.018831f, 0.056781f}},
    {"Shampoo", {0.0007176f, 0.0008303f, 0.0009016f}, {0.014107f, 0.045693f, 0.061717f}},
    {"Strawberry Shampoo", {0.00015671f, 0.00015947f, 1.518e-05f}, {0.01449f, 0.05796f, 0.075823f}},
    {"Head & Shoulders Shampoo",
     {0.023805f, 0.028804f, 0.034306f},
     {0.084621f, 0.15688f, 0.20365f}},
    {"Lemon Tea Powder", {0.040224f, 0.045264f, 0.051081f}, {2.4288f, 4.5757f, 7.2127f}},
    {"Orange Powder", {0.00015617f, 0.00017482f, 0.0001762f}, {0.001449f, 0.003441f, 0.007863f}},
    {"Pink Lemonade Powder",
     {0.00012103f, 0.00013073f, 0.00012528f},
     {0.001165f, 0.002366f, 0.003195f}},
    {"Cappuccino Powder", {1.8436f, 2.5851f, 2.1662f}, {35.844f, 49.547f, 61.084f}},
    {"Salt Powder", {0.027333f, 0.032451f, 0.031979f}, {0.28415f, 0.3257f, 0.34148f}},
    {"Sugar Powder", {0.00022272f, 0.00025513f, 0.000271f}, {0.012638f, 0.031051f, 0.050124f}},
    {"Suisse Mocha Powder", {2.7979f, 3.5452f, 4.3365f}, {17.502f, 27.004f, 35.433f}},
    {"Pacific Ocean Surface Water",
     {0.0001764f, 0.00032095f, 0.00019617f},
     {0.031845f, 0.031324f, 0.030147f}},
};

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

bool FindMediumPreset(const std::string& name, Rgb* sigmaA, Rgb* sigmaS) {
    for (const Preset& preset : kPresets) {
        if (name != preset.name) continue;
        *sigmaA = Rgb::Map(preset.sigmaA);
        *sigmaS = Rgb::Map(preset.sigmaS);
        return true;
    }
    return false;
}

}  // namespace lull
