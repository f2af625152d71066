// Checks that directions are sampled with the density that is claimed for them.
#include <gtest/gtest.h>

#include "tests/renderer/bsdf/lobe_examples.h"
#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull::test {
namespace {

const double kAngles[] = {0, 30, 60, 85, 89.5, 95, 120, 150, 180};

// Returns where a lobe's density peaks: the mirrored or the refracted direction.
Vec3f PeakOf(const Lobe& lobe, const Vec3f& wo) {
    Vec3f peak(-wo.x(), -wo.y(), wo.z());
    if (const auto* t = std::get_if<MicrofacetTransmission>(&lobe))
        if (!Refract(wo, {0, 0, std::copysign(1.f, wo.z())}, wo.z() > 0 ? 1 / t->eta : t->eta,
                     &peak))
            peak = Vec3f(-wo.x(), -wo.y(), -wo.z());
    if (std::holds_alternative<ThinTransmission>(lobe)) peak = -wo;
    return peak.normalized();
}

SphereGrid GridFor(const Lobe& lobe, const Vec3f& wo) {
    const float alpha = AlphasOf(lobe).minCoeff();
    if (alpha >= 0.05f) return EvenGrid(32, 24);
    return PeakedGrid(PeakOf(lobe, wo), 0.1 * alpha, 24, 12);
}

// Returns the density of what is really sampled: without the microfacets that wo sees from behind.
double SampledDensity(const Bsdf& bsdf, const Vec3f& wo, const Vec3f& wi) {
    double pdf = bsdf.Evaluate(wo, wi, LobeSet::NonSpecular).pdf;
    for (int i = 0; i < bsdf.LobeCount(LobeSet::All); ++i)
        if (!IsFrontFacing(bsdf.At(i), wo, wi))
            pdf -= std::get<MicrofacetTransmission>(bsdf.At(i)).Evaluate(wo, wi).pdf /
                   bsdf.LobeCount(LobeSet::NonSpecular);
    return pdf;
}

// Returns the p-value of samples of the Bsdf's lobes that are not specular.
double PValue(const Bsdf& bsdf, const Vec3f& wo, const SphereGrid& grid, uint64_t seed,
              double* total) {
    return PValueOf(
        grid, [&](const Vec3f& wi) { return SampledDensity(bsdf, wo, wi); }, 50'000, seed,
        [&](Random& random) {
            return SampleSpread(bsdf, wo, random.Point(), LobeSet::NonSpecular);
        },
        total);
}

TEST(LobeSampling, FollowsItsDensity) {
    const std::vector<NamedLobe> lobes = SpreadLobes();
    const double significance = Significance(int(lobes.size() * std::size(kAngles)));
    uint64_t seed = 1000;
    for (const NamedLobe& l : lobes)
        for (double angle : kAngles) {
            const Vec3f wo = FromAngles(angle, 37);
            double total;
            const double p = PValue(MakeBsdf({l.lobe}), wo, GridFor(l.lobe, wo), ++seed, &total);
            EXPECT_GT(p, significance) << l.name << ", " << angle << " degrees, seed " << seed;
            EXPECT_LT(total, 1 + 2e-3) << l.name << ", " << angle << " degrees";
        }
}

TEST(BsdfSampling, FollowsItsDensity) {
    const Rgb c(0.5f, 0.6f, 0.7f);
    const TrowbridgeReitz d(0.3f, 0.3f), e(0.6f, 0.4f);
    const std::vector<std::vector<Lobe>> bsdfs = {
        {LambertianReflection{c}, DielectricReflection{c, d, {1 / 1.5f}}},
        {DielectricReflection{c, e, {1.5f}}, MicrofacetTransmission{c, e, 1.5f}},
        {LambertianReflection{c}, LambertianTransmission{c}, DielectricReflection{c, d, {1.5f}},
         MicrofacetTransmission{c, d, 1.5f}},
        // Specular lobes stand aside.
        {SpecularTransmission{c, 1}, LambertianReflection{c}, DielectricReflection{c, e, {1.5f}},
         SpecularReflection<DielectricInterface>{c, {1.5f}}, SpecularTransmission{c, 1.5f}},
        {FresnelBlend{c, c, d}, OrenNayar(c, 30), FresnelSpecular{c, c, 1.5f},
         LambertianTransmission{c}},
    };
    const double significance = Significance(int(bsdfs.size() * std::size(kAngles)));
    uint64_t seed = 2000;
    for (const std::vector<Lobe>& lobes : bsdfs)
        for (double angle : kAngles) {
            const Vec3f wo = FromAngles(angle, 200);
            double total;
            const double p = PValue(MakeBsdf(lobes), wo, EvenGrid(20, 24), ++seed, &total);
            EXPECT_GT(p, significance)
                << lobes.size() << " lobes, " << angle << " degrees, seed " << seed;
            EXPECT_LT(total, 1 + 2e-3);
        }
}

// Lobes of very different shares: a coat over a dark or a bright base, parts of one lobe, and
// specular lobes among others.
std::vector<std::vector<Lobe>> UnevenLobes() {
    const Rgb dark(0.02f, 0.03f, 0.01f), bright(0.8f, 0.7f, 0.9f);
    const TrowbridgeReitz d(0.3f, 0.3f), e(0.6f, 0.4f);
    return {{LambertianReflection{bright}, DielectricReflection{bright, d, {1.5f}}},
            {LambertianReflection{dark}, DielectricReflection{bright, e, {1.5f}}},
            {FresnelBlend{bright, dark, d}},
            {FresnelBlend{dark, bright, d}, OrenNayar(bright, 30), LambertianTransmission{dark}},
            {SpecularTransmission{bright, 1}, LambertianReflection{dark},
             DielectricReflection{bright, e, {1.5f}},
             SpecularReflection<DielectricInterface>{bright, {1.5f}}}};
}

TEST(BsdfSampling, ByShareFollowsItsDensity) {
    const double significance = Significance(int(UnevenLobes().size() * std::size(kAngles)));
    uint64_t seed = 3000;
    for (const std::vector<Lobe>& lobes : UnevenLobes())
        for (double angle : kAngles) {
            const Vec3f wo = FromAngles(angle, 200);
            Bsdf bsdf = MakeBsdf(lobes);
            bsdf.ChooseByShare(wo);
            double total;
            const double p = PValueOf(
                EvenGrid(20, 24),
                [&](const Vec3f& wi) { return double(bsdf.Evaluate(wo, wi, LobeSet::All).pdf); },
                50'000, ++seed,
                [&](Random& random) {
                    const auto s = bsdf.Sample(wo, random.Point(), LobeSet::All);
                    if (!s || s->isSpecular) return std::optional<Vec3f>();
                    EXPECT_NEAR(s->pdf, bsdf.Evaluate(wo, s->wi, LobeSet::All).pdf, 2e-3f * s->pdf);
                    return std::optional(s->wi);
                },
                &total);
            EXPECT_GT(p, significance)
                << lobes.size() << " lobes, " << angle << " degrees, seed " << seed;
        }
}

// However lobes are chosen, the light that they scatter is the same; by share with no more noise.
TEST(BsdfSampling, ByShareLeavesTheMeanAsItIs) {
    for (const std::vector<Lobe>& lobes : UnevenLobes()) {
        const Vec3f wo = FromAngles(40, 200);
        const Bsdf uniform = MakeBsdf(lobes);
        Bsdf byShare = uniform;
        byShare.ChooseByShare(wo);
        SampleMean means[2];
        for (const int which : {0, 1}) {
            const Bsdf& bsdf = which ? byShare : uniform;
            Random random(5 + which);
            for (int i = 0; i < 40'000; ++i) {
                const auto s = bsdf.Sample(wo, random.Point(), LobeSet::All);
                means[which].Add(s ? s->f.sum() * std::abs(s->wi.z()) / s->pdf : 0);
            }
        }
        EXPECT_NEAR(means[0].Value(), means[1].Value(),
                    4.5 * std::hypot(means[0].Error(), means[1].Error()))
            << lobes.size() << " lobes";
        EXPECT_LT(means[1].Variance(), 1.1 * means[0].Variance()) << lobes.size() << " lobes";

        const Bsdf again = byShare.WithoutShares();
        const Vec3f wi = FromAngles(20, 10);
        EXPECT_EQ(again.Evaluate(wo, wi, LobeSet::All).pdf,
                  uniform.Evaluate(wo, wi, LobeSet::All).pdf);
    }
}

// The remapped number must be uniform again: each lobe's own samples follow its own density.
TEST(BsdfSampling, RemapsTheNumberThatChoseTheLobe) {
    const Rgb c(0.5f, 0.5f, 0.5f);
    const TrowbridgeReitz d(0.5f, 0.5f);
    const Bsdf bsdf = MakeBsdf(
        {LambertianReflection{c}, MicrofacetTransmission{c, d, 1.5f}, LambertianReflection{c}});
    const Bsdf only = MakeBsdf({MicrofacetTransmission{c, d, 1.5f}});
    const Vec3f wo = FromAngles(50);
    Random random(3);
    for (int i = 0; i < 1000; ++i) {
        const Vec2f u = random.Point();
        const auto a = bsdf.Sample(wo, {(1 + u.x()) / 3, u.y()}, LobeSet::All);
        const auto b = only.Sample(wo, u, LobeSet::All);
        ASSERT_EQ(a.has_value(), b.has_value());
        if (!a) continue;
        EXPECT_LT((a->wi - b->wi).norm(), 1e-3f);
        EXPECT_NEAR(a->pdf, b->pdf / 3, 1e-3f * b->pdf);
        EXPECT_TRUE(a->isTransmission);
    }
}

}  // namespace
}  // namespace lull::test
