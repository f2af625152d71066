// Compares mean and variance of one sample, f cos / pdf, with integrals of textbook formulas: what
// makes an image's noise the noise people have judged.
#include <gtest/gtest.h>

#include "tests/renderer/bsdf/lobe_examples.h"
#include "tests/renderer/bsdf/reference_lobes.h"
#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull::test {
namespace {

constexpr double kPi2 = std::numbers::pi;

// Gives one lobe's value; f as it is anywhere, pdf as it is sampled.
using Reference = std::function<ReferenceValue(const Vec3d& wo, const Vec3d& wi)>;

struct Example {
    std::string name;
    std::vector<Lobe> lobes;
    std::vector<Reference> references;
};

ReferenceValue Diffuse(double albedo, const Vec3d& wo, const Vec3d& wi) {
    if (wo.z() * wi.z() <= 0) return {0, 0};
    return {albedo / kPi2, std::abs(wi.z()) / kPi2};
}

std::vector<Example> Examples() {
    const ReferenceDistribution d{0.4, 0.4}, a{0.7, 0.25};
    const TrowbridgeReitz df(0.4f, 0.4f), af(0.7f, 0.25f);
    const Rgb white(1, 1, 1), half(0.5f, 0.5f, 0.5f);
    const auto coat = [=](const Vec3d& wo, const Vec3d& wi) -> ReferenceValue {
        if (wo.z() * wi.z() <= 0) return {0, 0};
        const auto fresnel = [](double c) { return ReferenceDielectric(c, 1 / 1.5); };
        return ReferenceReflection(d, fresnel, wo, wi);
    };
    const auto metal = [=](const Vec3d& wo, const Vec3d& wi) -> ReferenceValue {
        if (wo.z() * wi.z() <= 0) return {0, 0};
        const auto fresnel = [](double c) {
            return ReferenceFresnel(std::abs(c), std::complex<double>(0.2, 3.9));
        };
        return ReferenceReflection(a, fresnel, wo, wi);
    };
    const auto glassUp = [=](const Vec3d& wo, const Vec3d& wi) -> ReferenceValue {
        if (wo.z() * wi.z() <= 0) return {0, 0};
        const auto fresnel = [](double c) { return ReferenceDielectric(c, 1.5); };
        return ReferenceReflection(a, fresnel, wo, wi);
    };
    const auto glassDown = [=](const Vec3d& wo, const Vec3d& wi) -> ReferenceValue {
        const Vec3d h = wo + (wo.z() > 0 ? 1.5 : 1 / 1.5) * wi;
        if (wo.dot(h) * wo.z() * h.z() <= 0) return {0, 0};  // pbrt-v3 never samples these
        return ReferenceTransmission(a, 1.5, wo, wi);
    };
    const auto diffuse = [](const Vec3d& wo, const Vec3d& wi) { return Diffuse(0.5, wo, wi); };
    const auto rough = [](const Vec3d& wo, const Vec3d& wi) {
        ReferenceValue v = Diffuse(0.5, wo, wi);
        if (v.pdf > 0) v.f = 0.5 * ReferenceOrenNayar(40, wo, wi);
        return v;
    };
    return {
        {"matte", {OrenNayar(half, 40)}, {rough}},
        {"plastic",
         {LambertianReflection{half}, DielectricReflection{white, df, {1 / 1.5f}}},
         {diffuse, coat}},
        {"metal", {ConductorReflection{white, af, {Rgb(0.2f, 1, 1), Rgb(3.9f, 1, 1)}}}, {metal}},
        {"glass",
         {DielectricReflection{white, af, {1.5f}}, MicrofacetTransmission{white, af, 1.5f}},
         {glassUp, glassDown}},
    };
}

TEST(Moments, MeanAndVarianceOfOneSampleAreTheIntegrals) {
    uint64_t seed = 4000;
    for (const Example& e : Examples())
        for (double angle : {5.0, 50.0, 80.0, 110.0, 160.0}) {
            const Vec3f wo = FromAngles(angle, 25);
            const auto moment = [&](int power) {
                const auto cells = Integrate(EvenGrid(32, 24), [&](const Vec3f& wi) {
                    ReferenceValue sum{0, 0};
                    for (const Reference& r : e.references) {
                        const ReferenceValue v = r(wo.cast<double>(), wi.cast<double>());
                        sum.f += v.f;
                        sum.pdf += v.pdf / double(e.references.size());
                    }
                    const double x = sum.f * std::abs(wi.z());
                    return sum.pdf > 0 ? std::pow(x, power) / std::pow(sum.pdf, power - 1) : 0;
                });
                double total = 0;
                for (double c : cells) total += c;
                return total;
            };

            const Bsdf bsdf = MakeBsdf(e.lobes);
            constexpr int kSamples = 400'000;
            double sums[5] = {};
            Random random(++seed);
            for (int i = 0; i < kSamples; ++i) {
                const auto s = bsdf.Sample(wo, random.Point(), LobeSet::NonSpecular);
                if (!s) continue;
                const double x = s->f.x() * std::abs(s->wi.z()) / s->pdf;
                for (int k = 1; k < 5; ++k) sums[k] += std::pow(x, k) / kSamples;
            }
            for (int k : {1, 2}) {
                const double sigma = std::sqrt((sums[2 * k] - sums[k] * sums[k]) / kSamples);
                EXPECT_NEAR(sums[k], moment(k), 4.5 * sigma + 1e-4)
                    << e.name << ", moment " << k << ", " << angle << " degrees, seed " << seed;
            }
        }
}

}  // namespace
}  // namespace lull::test
