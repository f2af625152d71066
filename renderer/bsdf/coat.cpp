#include "renderer/bsdf/coat.h"
#include "stopping/base/hash.h"

#include <bit>
#include <optional>

namespace lull {
namespace {

float CosineInside(float cosine, float eta) {
    return std::sqrt(std::max(1 - (1 - Sqr(cosine)) / Sqr(eta), 1e-12f));
}

float Lambda(const TrowbridgeReitz& distribution, const Vec3f& w) {
    return 0.5f * (distribution.Stretch(w) / std::abs(w.z()) - 1);
}

float MaskingOfSecond(const TrowbridgeReitz& d, const Vec3f& v, const Vec3f& w) {
    const float first = 1 + Lambda(d, v);
    return first / (first + Lambda(d, w));
}

Vec3f LatticePoint(int i) {
    const auto fraction = [](double x) { return float(x - std::floor(x)); };
    return {fraction(0.5 + 0.8191725133961645 * i), fraction(0.5 + 0.6710436067037893 * i),
            fraction(0.5 + 0.5497004779019703 * i)};
}

float Attenuation(float thickness, const Vec3f& w) {
    return thickness > 0 ? std::exp(-thickness / std::max(std::abs(w.z()), 1e-6f)) : 1;
}

constexpr int kRows = 33;  // of rough coats

float AlphaOfRow(int i) { return std::max(1e-3f, Sqr(float(i) / (kRows - 1))); }

class WalkNumbers {
  public:
    WalkNumbers(const Vec3f& wo, const Vec3f& wi) {
        for (const float x : {wo.x(), wo.y(), wo.z(), wi.x(), wi.y(), wi.z()})
            state = MixBits(state ^ std::bit_cast<uint32_t>(x));
    }
    float Get1D() {
        state += 0x9e3779b97f4a7c15ull;
        return UnitFloat(MixBits(state));
    }
    Vec2f Get2D() {
        const float x = Get1D();
        return {x, Get1D()};
    }

  private:
    uint64_t state = 0x2545f4914f6cdd1dull;
};

// Read the roughness that a coated conductor stores of an interface.
float AlphaOf(uint16_t stored) { return float(stored) / CoatedConductorLobe::kAlphaUnits; }
TrowbridgeReitz DistributionOf(const uint16_t (&alpha)[2]) {
    return {AlphaOf(alpha[0]), AlphaOf(alpha[1])};
}
bool IsSmooth(const uint16_t (&alpha)[2]) { return alpha[0] == 0 && alpha[1] == 0; }

class ConductorWalk {
  public:
    explicit ConductorWalk(const CoatedConductorLobe& lobe)
        : eta(lobe.eta),
          thickness(lobe.thickness),
          conductor(Rgb(lobe.n), Rgb(lobe.k)),
          coat(DistributionOf(lobe.coatAlpha)),
          base(DistributionOf(lobe.baseAlpha)),
          isCoatSmooth(IsSmooth(lobe.coatAlpha)),
          isBaseSmooth(IsSmooth(lobe.baseAlpha)) {}

    Rgb Estimate(const Vec3f& wo, const Vec3f& wi, WalkNumbers& numbers) const {
        const auto enter = Enter(wo, numbers), leave = Enter(wi, numbers);
        if (!enter || !leave) return Rgb::Zero();
        Rgb f = Rgb::Zero(), beta = Rgb::Constant(enter->weight / Sqr(eta));
        Vec3f w = -enter->w;  // from the base to the coat
        const Vec3f out = -leave->w;
        for (int depth = 0; depth < kMostEvents; depth += 2) {
            if (depth > 3 && beta.maxCoeff() < 0.25f) {
                const float end = std::max(0.f, 1 - beta.maxCoeff());
                if (numbers.Get1D() < end) break;
                beta /= 1 - end;
            }
            beta *= Attenuation(w);
            if (!isBaseSmooth) {
                const float weight = isCoatSmooth ? 1 : Power(leave->pdf, BasePdf(w, out));
                f += beta * BaseValue(w, out) * (weight * Attenuation(out) * leave->weight);
            }
            const auto bounce = Bounce(w, numbers);
            if (!bounce) break;
            beta *= bounce->weight;
            w = bounce->w;
            if (!isCoatSmooth) {
                float pdf;
                const float through = Leaving(w, wi, &pdf);
                const float weight = isBaseSmooth ? 1 : Power(bounce->pdf, pdf);
                f += beta * (Attenuation(w) * through * weight);
            }
            beta *= Attenuation(w);
            const auto back = ReflectInside(w, numbers);
            if (!back) break;
            beta *= back->weight;
            w = back->w;
        }
        return f;
    }

    float Reflected(const Vec3f& wo, const Vec3f& wi) const {
        if (isCoatSmooth) return 0;
        const Vec3f h = wo + wi;
        const float h2 = h.squaredNorm();
        if (!(h2 > kMinHalf2)) return 0;
        const float so = coat.Stretch(wo), si = coat.Stretch(wi);
        return FresnelDielectric(0.5f * std::sqrt(h2), eta) * 0.5f * coat.D(h, h2) /
               (wi.z() * so + wo.z() * si);
    }

  private:
    static constexpr int kMostEvents = 10;
    struct Crossing {
        Vec3f w;  // below the coat
        float weight, pdf;
    };
    struct Reflection {
        Vec3f w;
        Rgb weight;
        float pdf;
    };

    static float Power(float a, float b) { return a > 0 ? Sqr(a) / (Sqr(a) + Sqr(b)) : 0; }
    float Attenuation(const Vec3f& w) const { return lull::Attenuation(thickness, w); }

    std::optional<Crossing> Enter(const Vec3f& w, WalkNumbers& numbers) const {
        const Vec2f u = numbers.Get2D();
        const Vec3f h = isCoatSmooth ? Vec3f(Vec3f::UnitZ()) : coat.SampleVisibleNormal(w, u);
        Crossing c;
        if (!Refract(w, h, 1 / eta, &c.w) || !(c.w.z() < -kMinCosine)) return {};
        c.weight = 1 - FresnelDielectric(w.dot(h), eta);
        c.pdf = 1;
        if (!isCoatSmooth) {
            c.weight *= MaskingOfSecond(coat, w, c.w);
            const float inside = std::abs(c.w.dot(h)), outside = w.dot(h);
            c.pdf = VisiblePdf(coat, w, h) * inside * Sqr(eta) / Sqr(outside - eta * inside);
        }
        return c;
    }

    static float VisiblePdf(const TrowbridgeReitz& d, const Vec3f& w, const Vec3f& h) {
        const float cosine = std::abs(w.z());
        return d.D(h, 1) * 2 * std::abs(w.dot(h)) / (cosine + d.Stretch(w));
    }

    // Reflects at the inside of the coat. By symmetry w and the result, which point up from the
    // base, are what -w and its reflection are below the coat.
    std::optional<Reflection> ReflectInside(const Vec3f& w, WalkNumbers& numbers) const {
        const Vec2f u = numbers.Get2D();
        const Vec3f h = isCoatSmooth ? Vec3f(Vec3f::UnitZ()) : coat.SampleVisibleNormal(w, u);
        const Vec3f out = (2 * w.dot(h)) * h - w;
        if (!(out.z() > kMinCosine)) return {};
        float weight = FresnelDielectric(w.dot(h), 1 / eta);
        if (!isCoatSmooth) weight *= MaskingOfSecond(coat, w, out);
        return Reflection{out, Rgb::Constant(weight), 0};
    }

    std::optional<Reflection> Bounce(const Vec3f& w, WalkNumbers& numbers) const {
        const Vec2f u = numbers.Get2D();
        const Vec3f h = isBaseSmooth ? Vec3f(Vec3f::UnitZ()) : base.SampleVisibleNormal(w, u);
        const Vec3f out = (2 * w.dot(h)) * h - w;
        if (!(out.z() > kMinCosine)) return {};
        Reflection r{out, conductor(w.dot(h)), 0};
        if (!isBaseSmooth) {
            r.weight *= MaskingOfSecond(base, w, out);
            r.pdf = BasePdf(w, out);
        }
        return r;
    }
    Rgb BaseValue(const Vec3f& w, const Vec3f& out) const {
        const Vec3f h = w + out;
        const float h2 = h.squaredNorm();
        if (!(h2 > kMinHalf2)) return Rgb::Zero();
        const float s = base.Stretch(w), t = base.Stretch(out);
        return conductor(0.5f * std::sqrt(h2)) * (0.5f * base.D(h, h2) / (out.z() * s + w.z() * t));
    }
    float BasePdf(const Vec3f& w, const Vec3f& out) const {
        const Vec3f h = w + out;
        const float h2 = h.squaredNorm();
        return h2 > kMinHalf2 ? 0.5f * base.D(h, h2) / (w.z() + base.Stretch(w)) : 0;
    }

    // Returns f of light from wi that goes through the coat and down against `up`, for radiance,
    // and the density with which Enter(wi) finds that direction. (pbrt-v4 weighs by that of the way
    // out, so that its weights do not quite add up to 1.)
    float Leaving(const Vec3f& up, const Vec3f& wi, float* pdf) const {
        *pdf = 0;
        const Vec3f inside = -up;  // away from the interface
        Vec3f h = eta * inside + wi;
        const float h2 = h.squaredNorm();
        if (!(h2 > kMinHalf2)) return 0;
        h /= h.z() < 0 ? -std::sqrt(h2) : std::sqrt(h2);
        const float oh = inside.dot(h), ih = wi.dot(h);
        if (!(oh < 0 && ih > 0)) return 0;
        const float through = 1 - FresnelDielectric(ih, eta);
        const float d = coat.D(h, 1), denominator = Sqr(eta * oh + ih);
        const float masking = 1 / (1 + Lambda(coat, inside) + Lambda(coat, wi));
        *pdf = VisiblePdf(coat, wi, h) * std::abs(oh) * Sqr(eta) / denominator;
        return through * d * masking * Sqr(eta) * std::abs(oh * ih) /
               (std::abs(inside.z()) * wi.z() * denominator);
    }

    float eta, thickness;
    ConductorInterface conductor;
    TrowbridgeReitz coat, base;
    bool isCoatSmooth, isBaseSmooth;
};

// How samples are spread: over the coat's reflection, that of the base as it is seen through the
// coat, and, so that no direction is left out, all others.
struct Shares {
    float coat, base, rest;
};
Shares SharesOf(const CoatedConductorLobe& lobe, float cosine) {
    const float f = FresnelDielectric(cosine, lobe.eta);
    const float coat = IsSmooth(lobe.coatAlpha) ? 0 : std::clamp(f, 0.05f, 0.8f);
    return {coat, 0.9f * (1 - coat), 0.1f * (1 - coat)};
}

// The view multiplies slopes of the base by the index, slopes of the coat by its distance from 1.
TrowbridgeReitz SeenBase(const CoatedConductorLobe& lobe) {
    const auto along = [&](int i) {
        const float coat = AlphaOf(lobe.coatAlpha[i]), base = AlphaOf(lobe.baseAlpha[i]);
        return std::sqrt(Sqr(lobe.eta * base) + 2 * Sqr((lobe.eta - 1) * coat));
    };
    return {along(0), along(1)};
}

}  // namespace

float CoatRow::Through(float cosine) const {
    if (isSmooth)
        return (1 - FresnelDielectric(cosine, eta)) *
               std::exp(-thickness / CosineInside(cosine, eta));
    const float first = CosineAt(1);
    if (cosine < first) return through[0] + cosine / first * (through[1] - through[0]);
    const float x = std::min(cosine * (kCosines - 1) + 0.5f, float(kCosines - 1));
    const int i = std::min(int(x), kCosines - 2);
    const float t = x - float(i);
    return (1 - t) * through[size_t(i)] + t * through[size_t(i) + 1];
}

CoatRow MakeCoatRow(float alpha, float eta, float thickness) {
    constexpr int kDirections = 4096, kNormals = 1024;
    CoatRow row{.eta = eta, .thickness = thickness, .isSmooth = alpha == 0};
    const TrowbridgeReitz distribution(alpha, alpha);
    const auto attenuation = [&](const Vec3f& w) { return Attenuation(thickness, w); };
    if (!row.isSmooth)
        for (int i = 0; i < CoatRow::kCosines; ++i) {
            const float cosine = CoatRow::CosineAt(i);
            const Vec3f wo(std::sqrt(1 - Sqr(cosine)), 0, cosine);
            double sum = 0;
            for (int k = 0; k < kNormals; ++k) {
                const Vec3f h = distribution.SampleVisibleNormal(wo, LatticePoint(k).head<2>());
                Vec3f wi;
                if (!Refract(wo, h, 1 / eta, &wi) || !(wi.z() < 0)) continue;
                sum += double((1 - FresnelDielectric(wo.dot(h), eta)) *
                              MaskingOfSecond(distribution, wo, wi) * attenuation(wi));
            }
            row.through[size_t(i)] = float(sum / kNormals);
        }
    double returned = 0, escaping = 0;
    for (int k = 0; k < kDirections; ++k) {
        const Vec3f u = LatticePoint(k);
        // Down to the coat from the base, as seen from the coat.
        const float cosine = std::sqrt(std::max(u.x(), 1e-6f));
        const Vec3f w(std::sqrt(1 - Sqr(cosine)), 0, cosine);
        if (row.isSmooth) {
            returned += double(FresnelDielectric(cosine, 1 / eta) * Sqr(attenuation(w)));
            continue;
        }
        const Vec3f h = distribution.SampleVisibleNormal(w, u.tail<2>());
        const Vec3f o = (2 * w.dot(h)) * h - w;
        if (!(o.z() > 0)) continue;
        returned += double(FresnelDielectric(w.dot(h), 1 / eta) *
                           MaskingOfSecond(distribution, w, o) * attenuation(w) * attenuation(o));
    }
    row.returned = float(returned / kDirections);
    // By reciprocity, the transmittance to a diffuse light.
    constexpr int kSteps = 256;
    for (int i = 0; i < kSteps; ++i) {
        const float cosine = (float(i) + 0.5f) / kSteps;
        escaping += double(2 * cosine * row.Through(cosine)) / kSteps;
    }
    row.escaping = float(escaping) / Sqr(eta);
    return row;
}

CoatTable::CoatTable(float alpha, float eta, float thickness) : isConstant(true) {
    rows.push_back(MakeCoatRow(alpha, eta, thickness));
}

CoatTable::CoatTable(float eta, float thickness) : isConstant(false) {
    rows.push_back(MakeCoatRow(0, eta, thickness));
    for (int i = 0; i < kRows; ++i) rows.push_back(MakeCoatRow(AlphaOfRow(i), eta, thickness));
}

const CoatRow* CoatTable::RowOf(float alpha, float* blend) const {
    *blend = 0;
    if (isConstant || alpha == 0) return rows.data();
    const float x = std::min(std::sqrt(alpha), 1.f) * (kRows - 1);
    const int i = std::min(int(x), kRows - 2);
    *blend = x - float(i);
    return &rows[size_t(i) + 1];
}

Rgb CoatedConductorInterface::operator()(float cosine) const {
    const float mu = std::abs(cosine), inside = CosineInside(mu, eta);
    const float f = FresnelDielectric(mu, eta), q = std::exp(-2 * thickness / inside);
    const ConductorInterface conductor{Rgb(n), Rgb(k)};
    const Rgb base = conductor(inside) * q, again = base * f;
    return f + Sqr(1 - f) * base * (1 + again * (1 + again * (1 + again * (1 + again))));
}

uint16_t CoatedConductorLobe::StoreAlpha(float alpha) {
    return uint16_t(std::clamp(alpha * kAlphaUnits + 0.5f, 0.f, 65535.f));
}

BsdfValue CoatedConductorLobe::Evaluate(const Vec3f& woGiven, const Vec3f& wiGiven) const {
    constexpr int kWalks = 4;
    if (!SameHemisphere(woGiven, wiGiven)) return {};
    const float side = woGiven.z() < 0 ? -1 : 1;
    const Vec3f wo = side * woGiven, wi = side * wiGiven;
    if (std::min(wo.z(), wi.z()) < 1e-6f) return {};
    const ConductorWalk walk(*this);
    WalkNumbers numbers(wo, wi);
    BsdfValue value;
    for (int i = 0; i < kWalks; ++i) value.f += walk.Estimate(wo, wi, numbers) / kWalks;
    value.f += walk.Reflected(wo, wi);
    value.f *= Rgb(scale);
    const Shares shares = SharesOf(*this, wo.z());
    const Vec3f h = wo + wi;
    const float h2 = h.squaredNorm();
    value.pdf = shares.rest * wi.z() * kInvPi;
    if (h2 > kMinHalf2) {
        const auto pdf = [&](const TrowbridgeReitz& d) {
            return 0.5f * d.D(h, h2) / (wo.z() + d.Stretch(wo));
        };
        value.pdf += shares.base * pdf(SeenBase(*this));
        if (shares.coat > 0) value.pdf += shares.coat * pdf(DistributionOf(coatAlpha));
    }
    return value;
}

bool CoatedConductorLobe::Sample(const Vec3f& wo, const Vec2f& u, Vec3f* wi) const {
    const Shares shares = SharesOf(*this, std::abs(wo.z()));
    float x = u.x();
    if (x < shares.rest) {
        *wi = SampleCosine(wo, {std::min(x / shares.rest, kOneMinusEpsilon), u.y()}, false);
        return true;
    }
    x -= shares.rest;
    const bool ofBase = x < shares.base;
    x = ofBase ? x / shares.base : (x - shares.base) / shares.coat;
    const TrowbridgeReitz distribution = ofBase ? SeenBase(*this) : DistributionOf(coatAlpha);
    const Vec3f h = distribution.SampleVisibleNormal(wo, {std::min(x, kOneMinusEpsilon), u.y()});
    *wi = (2 * wo.dot(h)) * h - wo;
    return SameHemisphere(wo, *wi);
}

}  // namespace lull
