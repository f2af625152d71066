#include "renderer/bsdf/hair_lobe.h"

#include "renderer/base/math.h"

namespace lull {
namespace {

// The paths through the hair: 0 reflected, 1 straight through, 2 once reflected inside, 3 the rest.
constexpr int kPaths = 4, kRest = kPaths - 1;

// Computes the logarithm of the modified Bessel function I0 at x >= 0 (Abramowitz and Stegun 1964,
// 9.6.12; for large x the beginning of 9.7.1).
double LogBesselI0(double x) {
    if (x > 12) return x + 0.5 * (-std::log(2 * std::numbers::pi) + std::log(1 / x) + 1 / (8 * x));
    double sum = 1, term = 1;
    for (int i = 1; i < 10; ++i) {
        term *= Sqr(x / (2 * i));
        sum += term;
    }
    return std::log(sum);
}

double Longitudinal(double cosI, double cosO, double sinI, double sinO, double v) {
    const double a = cosI * cosO / v, b = sinI * sinO / v;
    // 1 / (2 v sinh(1 / v)) as a logarithm.
    const double scale = -1 / v - std::log(v) - std::log1p(-std::exp(-2 / v));
    return std::exp(LogBesselI0(a) - b + scale);
}

double LogisticCdf(double x, double s) { return 1 / (1 + std::exp(-x / s)); }

// Returns the density of azimuths at distance x of the mean: a logistic cut off at +-pi.
double Azimuthal(double x, double s) {
    x = std::abs(std::remainder(x, 2 * std::numbers::pi));
    const double e = std::exp(-x / s);
    const double whole = 2 * LogisticCdf(std::numbers::pi, s) - 1;
    return e / (s * Sqr(1 + e)) / whole;
}

double SampleAzimuthal(double u, double s) {
    const double low = LogisticCdf(-std::numbers::pi, s);
    const double x = -s * std::log(1 / (low + u * (1 - 2 * low)) - 1);
    return std::clamp(x, -std::numbers::pi, std::numbers::pi);
}

struct Outgoing {
    float sinTheta, cosTheta, phi;
    float gammaO, gammaT;  // angles to the normal, outside and inside, across the hair
    std::array<Rgb, kPaths> attenuation;
    std::array<float, kPaths> pmf;  // of sampling each path

    Outgoing(const HairLobe& hair, const Vec3f& wo) {
        sinTheta = std::clamp(wo.x(), -1.f, 1.f);
        cosTheta = SafeSqrt(1 - Sqr(sinTheta));
        phi = std::atan2(wo.z(), wo.y());
        const float cosThetaT = std::max(SafeSqrt(1 - Sqr(sinTheta / hair.eta)), 1e-4f);
        // The cylinder is seen obliquely with another index across (Marschner, appendix B).
        const float across = SafeSqrt(Sqr(hair.eta) - Sqr(sinTheta)) / std::max(cosTheta, 1e-6f);
        const float sinGammaT = std::clamp(hair.h / std::max(across, 1e-6f), -1.f, 1.f);
        gammaO = std::asin(std::clamp(hair.h, -1.f, 1.f));
        gammaT = std::asin(sinGammaT);
        const Rgb through =
            (-Rgb(hair.sigmaA) * (2 * SafeSqrt(1 - Sqr(sinGammaT)) / cosThetaT)).exp();
        const float f = FresnelDielectric(cosTheta * SafeSqrt(1 - Sqr(hair.h)), hair.eta);
        attenuation[0] = Rgb::Constant(f);
        attenuation[1] = Sqr(1 - f) * through;
        attenuation[2] = attenuation[1] * through * f;
        // Of a perfect mirror nothing has got in.
        attenuation[kRest] =
            f < 1 ? Rgb(attenuation[2] * f * through / (1 - through * f)) : Rgb(Rgb::Zero());
        float sum = 0;
        for (int p = 0; p < kPaths; ++p) sum += pmf[p] = Luminance(attenuation[p]);
        if (!(sum > 0)) pmf[0] = sum = 1;
        for (float& m : pmf) m /= sum;
    }
};

// Returns sine and cosine of the outgoing angle, turned by the tilt of scales that path p meets.
std::pair<float, float> Tilted(const HairLobe& hair, const Outgoing& o, int p) {
    if (p == kRest) return {o.sinTheta, o.cosTheta};
    // The sines and cosines of the tilt's single, double and fourfold.
    std::array<float, 3> s, c;
    s[0] = hair.sinTilt;
    c[0] = SafeSqrt(1 - Sqr(s[0]));
    for (int k = 1; k < 3; ++k) {
        s[k] = 2 * c[k - 1] * s[k - 1];
        c[k] = Sqr(c[k - 1]) - Sqr(s[k - 1]);
    }
    const int k = p == 0 ? 1 : p == 1 ? 0 : 2;
    const float sinK = p == 0 ? -s[k] : s[k], cosK = c[k];
    return {o.sinTheta * cosK + o.cosTheta * sinK, o.cosTheta * cosK - o.sinTheta * sinK};
}

float VarianceOf(const HairLobe& hair, int p) {
    return p == 0 ? hair.variance : p == 1 ? 0.25f * hair.variance : 4 * hair.variance;
}

float MeanAzimuth(const Outgoing& o, int p) {
    return 2 * float(p) * o.gammaT - 2 * o.gammaO + float(p) * kPi;
}

Vec2f SplitBits(float u) {
    const auto bits = uint32_t(u * 0x1p24f);
    uint32_t even = 0, odd = 0;
    for (int i = 0; i < 12; ++i) {
        even |= (bits >> (2 * i) & 1) << i;
        odd |= (bits >> (2 * i + 1) & 1) << i;
    }
    return {(float(even) + 0.5f) * 0x1p-12f, (float(odd) + 0.5f) * 0x1p-12f};
}

}  // namespace

HairLobe::HairLobe(const Rgb& sigmaA, float h, float eta, float betaM, float betaN, float alpha)
    : r(Rgb(1, 1, 1)),
      sigmaA(sigmaA),
      h(std::clamp(h, -1.f, 1.f)),
      eta(std::max(eta, 1e-3f)),
      sinTilt(std::sin(alpha * (kPi / 180))) {
    const float m = std::clamp(betaM, 0.01f, 1.f), n = std::clamp(betaN, 0.01f, 1.f);
    variance = Sqr(0.726f * m + 0.812f * Sqr(m) + 3.7f * std::pow(m, 20.f));
    constexpr float kRootPiOver8 = 0.626657069f;
    logisticScale = kRootPiOver8 * (0.265f * n + 1.194f * Sqr(n) + 5.372f * std::pow(n, 22.f));
}

BsdfValue HairLobe::Evaluate(const Vec3f& wo, const Vec3f& wi) const {
    const Outgoing o(*this, wo);
    const float sinI = std::clamp(wi.x(), -1.f, 1.f), cosI = SafeSqrt(1 - Sqr(sinI));
    const float phi = std::atan2(wi.z(), wi.y()) - o.phi;
    BsdfValue sum;
    for (int p = 0; p < kPaths; ++p) {
        const auto [sinO, cosO] = Tilted(*this, o, p);
        const double along = Longitudinal(cosI, std::abs(cosO), sinI, sinO, VarianceOf(*this, p));
        const double around =
            p == kRest ? 0.5 / std::numbers::pi : Azimuthal(phi - MeanAzimuth(o, p), logisticScale);
        const auto density = float(along * around);
        sum.f += density * o.attenuation[p];
        sum.pdf += density * o.pmf[p];
    }
    sum.f *= Rgb(r) / std::max(std::abs(wi.z()), kMinCosine);
    return sum;
}

bool HairLobe::Sample(const Vec3f& wo, const Vec2f& u, Vec3f* wi) const {
    const Outgoing o(*this, wo);
    // Choose a path and use the rest of the number again.
    float x = u.x();
    int p = 0;
    for (; p < kRest && x >= o.pmf[p]; ++p) x -= o.pmf[p];
    x = o.pmf[p] > 0 ? std::clamp(x / o.pmf[p], 0.f, kOneMinusEpsilon) : 0.5f;

    const Vec2f split = SplitBits(u.y());
    const auto [sinO, cosO] = Tilted(*this, o, p);
    const double v = VarianceOf(*this, p);
    const double cosTheta =
        1 + v * std::log(double(split.x()) + (1 - double(split.x())) * std::exp(-2 / v));
    const double sinTheta = std::sqrt(std::max(0., 1 - Sqr(cosTheta)));
    const double sinI = -cosTheta * sinO + sinTheta * std::cos(2 * kPi * split.y()) * cosO;
    const double cosI = std::sqrt(std::max(0., 1 - Sqr(sinI)));
    const double dPhi = p == kRest ? 2 * std::numbers::pi * x
                                   : MeanAzimuth(o, p) + SampleAzimuthal(x, logisticScale);
    const double phi = o.phi + dPhi;
    *wi = Vec3f(float(sinI), float(cosI * std::cos(phi)), float(cosI * std::sin(phi)));
    return true;
}

Rgb HairAbsorption(float eumelanin, float pheomelanin) {
    return eumelanin * Rgb(0.419f, 0.697f, 1.37f) + pheomelanin * Rgb(0.187f, 0.4f, 1.05f);
}

Rgb HairAbsorptionOfColor(const Rgb& c, float betaN) {
    const float b = betaN, b2 = Sqr(b);
    const float divisor = 5.969f - 0.215f * b + 2.532f * b2 - 10.73f * b2 * b + 5.574f * Sqr(b2) +
                          0.245f * Sqr(b2) * b;
    return (c.max(1e-6f).log() / divisor).square();
}

}  // namespace lull
