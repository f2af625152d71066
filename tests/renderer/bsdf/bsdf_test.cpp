#include "renderer/bsdf/bsdf.h"

#include <gtest/gtest.h>

#include "renderer/base/math.h"
#include "tests/renderer/bsdf/lobe_examples.h"
#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull::test {
namespace {

const Rgb kGrey(0.5f, 0.5f, 0.5f), kRed(0.9f, 0.1f, 0.1f);

TEST(Bsdf, WithoutLobesScattersNothing) {
    const Bsdf bsdf = MakeBsdf({});
    EXPECT_EQ(bsdf.LobeCount(LobeSet::All), 0);
    EXPECT_EQ(bsdf.Evaluate(Vec3f::UnitZ(), Vec3f::UnitZ(), LobeSet::All).pdf, 0);
    EXPECT_FALSE(bsdf.Sample(Vec3f::UnitZ(), {0.5f, 0.5f}, LobeSet::All));
}

TEST(Bsdf, CountsSpecularLobesApart) {
    const Bsdf bsdf =
        MakeBsdf({SpecularTransmission{kGrey, 1}, LambertianReflection{kGrey},
                  FresnelSpecular{kGrey, kGrey, 1.5f}, LambertianTransmission{kGrey}});
    EXPECT_EQ(bsdf.LobeCount(LobeSet::All), 4);
    EXPECT_EQ(bsdf.LobeCount(LobeSet::NonSpecular), 2);
    // Both diffuse lobes have a density in every direction, of half the sphere each.
    const Vec3f wo = FromAngles(20), wi = FromAngles(60, 90);
    EXPECT_NEAR(bsdf.Evaluate(wo, wi, LobeSet::NonSpecular).pdf, 0.5f * kInvPi / 2, 1e-6f);
    EXPECT_NEAR(bsdf.Evaluate(wo, wi, LobeSet::All).pdf, 0.5f * kInvPi / 4, 1e-6f);
    EXPECT_TRUE(bsdf.Evaluate(wo, wi, LobeSet::All).f.isApprox(kGrey * kInvPi));
}

TEST(Bsdf, ChoosesLobesInTheirOrderWithTheFirstNumber) {
    const Bsdf bsdf =
        MakeBsdf({SpecularReflection<PerfectMirror>{kGrey, {}}, LambertianReflection{kGrey},
                  SpecularTransmission{kRed, 1}, LambertianTransmission{kRed}});
    const Vec3f wo = FromAngles(40);
    const auto sample = [&](float x, LobeSet set) { return *bsdf.Sample(wo, {x, 0.3f}, set); };
    EXPECT_TRUE(sample(0.1f, LobeSet::All).isSpecular);
    EXPECT_FALSE(sample(0.1f, LobeSet::All).isTransmission);
    EXPECT_FLOAT_EQ(sample(0.1f, LobeSet::All).pdf, 0.25f);
    EXPECT_FALSE(sample(0.3f, LobeSet::All).isSpecular);
    EXPECT_TRUE(sample(0.6f, LobeSet::All).isTransmission);
    EXPECT_LT((sample(0.6f, LobeSet::All).wi + wo).norm(), 1e-6f);
    EXPECT_TRUE(sample(0.6f, LobeSet::All).f.isApprox(kRed / wo.z()));
    EXPECT_TRUE(sample(0.9f, LobeSet::All).isTransmission);
    EXPECT_FALSE(sample(0.3f, LobeSet::NonSpecular).isTransmission);
    EXPECT_TRUE(sample(kOneMinusEpsilon, LobeSet::NonSpecular).isTransmission);
    EXPECT_FALSE(sample(kOneMinusEpsilon, LobeSet::NonSpecular).isSpecular);
}

TEST(Bsdf, GlassChoosesByFresnel) {
    const Bsdf bsdf = MakeBsdf({FresnelSpecular{kGrey, kRed, 1.5f}});
    const Vec3f up = Vec3f::UnitZ();
    const auto reflected = bsdf.Sample(up, {0.0399f, 0}, LobeSet::All);
    EXPECT_FALSE(reflected->isTransmission);
    EXPECT_NEAR(reflected->pdf, 0.04f, 1e-6f);
    EXPECT_TRUE((reflected->f / reflected->pdf).isApprox(kGrey, 1e-4f));
    const auto refracted = bsdf.Sample(up, {0.0401f, 0}, LobeSet::All);
    EXPECT_TRUE(refracted->isTransmission);
    EXPECT_NEAR(refracted->pdf, 0.96f, 1e-6f);
    EXPECT_TRUE((refracted->f / refracted->pdf).isApprox(kRed / 2.25f, 1e-4f));
    EXPECT_LT((refracted->wi + up).norm(), 1e-6f);
    // Beyond the critical angle everything is reflected.
    const auto total = bsdf.Sample(FromAngles(130), {kOneMinusEpsilon, 0}, LobeSet::All);
    EXPECT_FALSE(total->isTransmission);
    EXPECT_EQ(total->pdf, 1);
}

// Where shading and geometric normal disagree, the geometric one says what is reflection, while
// the density stays that of the sampling.
TEST(Bsdf, GeometricNormalSeparatesReflectionFromTransmission) {
    const Vec3f ng = FromAngles(60);
    const Bsdf bsdf = MakeBsdf({LambertianReflection{kGrey}, LambertianTransmission{kRed}}, ng);
    const Vec3f wo = Vec3f::UnitZ();
    const Vec3f above = FromAngles(80, 180);  // above the shading normal's plane only
    ASSERT_LT(above.dot(ng), 0);
    const BsdfValue leak = bsdf.Evaluate(wo, above, LobeSet::All);
    EXPECT_TRUE(leak.f.isApprox(kRed * kInvPi));
    EXPECT_NEAR(leak.pdf, above.z() * kInvPi / 2, 1e-6f);
    const Vec3f below = FromAngles(100);
    ASSERT_GT(below.dot(ng), 0);
    EXPECT_TRUE(bsdf.Evaluate(wo, below, LobeSet::All).f.isApprox(kGrey * kInvPi));

    // A sample that ends on the wrong side carries nothing.
    const Bsdf opaque = MakeBsdf({LambertianReflection{kGrey}}, ng);
    Random random(31);
    int refused = 0;
    for (int i = 0; i < 1000; ++i) {
        const auto s = opaque.Sample(wo, random.Point(), LobeSet::All);
        if (s)
            EXPECT_GT(s->wi.dot(ng), 0);
        else
            ++refused;
    }
    EXPECT_GT(refused, 0);
}

TEST(Bsdf, GrazingTheShadingPlaneIsRefused) {
    const Bsdf bsdf = MakeBsdf({LambertianReflection{kGrey}, FresnelSpecular{kGrey, kGrey, 1.5f}});
    EXPECT_EQ(bsdf.Evaluate(Vec3f::UnitX(), Vec3f::UnitZ(), LobeSet::All).pdf, 0);
    EXPECT_FALSE(bsdf.Sample(Vec3f::UnitX(), {0.2f, 0.2f}, LobeSet::All));
    EXPECT_FALSE(bsdf.Sample(Vec3f::UnitX(), {0.7f, 0.2f}, LobeSet::All));
}

// Sample and Evaluate answer alike for the direction that was sampled, up to what rounding wi to
// world space and back does to a narrow peak.
TEST(Bsdf, EvaluateAgreesWithSample) {
    Random random(32);
    std::vector<NamedLobe> spread = SpreadLobes(), all = spread;
    for (const NamedLobe& l : SpecularLobes()) all.push_back(l);
    for (int i = 0; i < 20000; ++i) {
        SCOPED_TRACE(i);
        const Vec3f n = random.Direction();
        Frame frame{{}, {}, n};
        CoordinateSystem(n, &frame.s, &frame.t);
        Bsdf bsdf(frame, (n + 0.3f * random.Direction()).normalized());
        float alpha = 1;
        for (int count = 1 + random.Below(4); count > 0; --count) {
            const Lobe& lobe = all[random.Below(int(all.size()))].lobe;
            alpha = std::min(alpha, AlphasOf(lobe).minCoeff());
            bsdf.Add(lobe);
        }
        const LobeSet set = random.Below(2) ? LobeSet::All : LobeSet::NonSpecular;
        const Vec3f wo = random.Direction();
        const auto s = bsdf.Sample(wo, random.Point(), set);
        if (!s || s->isSpecular || alpha < 0.04f) continue;
        const BsdfValue v = bsdf.Evaluate(wo, s->wi, set);
        EXPECT_NEAR(v.pdf, s->pdf, 1e-3f * s->pdf);
        // Sheen falls off with high powers of a sine, whose rounding counts as often.
        EXPECT_LT((v.f - s->f).abs().maxCoeff(), 1e-3f * s->f.maxCoeff() + 1e-12f);
    }
}

// With narrow peaks rounding matters, but less in a frame that is the axes.
TEST(Bsdf, EvaluateAgreesWithSampleInTheLocalFrame) {
    Random random(33);
    for (const NamedLobe& l : SpreadLobes()) {
        const Bsdf bsdf = MakeBsdf({l.lobe});
        for (int i = 0; i < 200; ++i) {
            const Vec3f wo = random.Direction();
            const auto s = bsdf.Sample(wo, random.Point(), LobeSet::All);
            if (!s) continue;
            const BsdfValue v = bsdf.Evaluate(wo, s->wi, LobeSet::All);
            EXPECT_FLOAT_EQ(v.pdf, s->pdf) << l.name << " " << i;
            EXPECT_NEAR(v.f.x(), s->f.x(), 1e-4f * s->f.x()) << l.name << " " << i;
        }
    }
}

Vec3f Direction(float cosine) { return {SafeSqrt(1 - cosine * cosine), 0, cosine}; }

// Is the estimate by which lobes are chosen, before its luminance is taken.
TEST(AlbedoOf, IsWhatLobesAreChosenBy) {
    for (const NamedLobe& example : SpreadLobes())
        for (const float cosine : {1.f, 0.4f, -0.7f}) {
            const Rgb albedo = AlbedoOf(MakeBsdf({example.lobe}), Direction(cosine));
            const float estimated = EstimatedAlbedo(example.lobe, Direction(cosine));
            EXPECT_GE(albedo.minCoeff(), 0) << example.name;
            EXPECT_LE(albedo.maxCoeff(), 1) << example.name;
            EXPECT_LE(Luminance(albedo), estimated + 1e-5f) << example.name;
            if (albedo.maxCoeff() < 1) {
                EXPECT_NEAR(Luminance(albedo), estimated, 1e-5f) << example.name;
            }
        }
}

TEST(AlbedoOf, IsTheColourOfSimpleSurfaces) {
    const Rgb color(0.9f, 0.5f, 0.2f), glass(1, 1, 1);
    for (const float cosine : {1.f, 0.3f, -0.3f}) {
        const Vec3f wo = Direction(cosine);
        EXPECT_TRUE(AlbedoOf(MakeBsdf({LambertianReflection{color}}), wo).isApprox(color, 1e-5f));
        EXPECT_TRUE(AlbedoOf(MakeBsdf({FresnelSpecular{glass, glass, 1.5f}}), wo).isApprox(glass));
        // Two lobes together, and never more than all light.
        const Bsdf both = MakeBsdf({LambertianReflection{color}, LambertianTransmission{color}});
        EXPECT_TRUE(AlbedoOf(both, wo).isApprox(Rgb(1, 1, 0.4f), 1e-5f));
    }
    EXPECT_TRUE(AlbedoOf(MakeBsdf({LambertianReflection{color}}), Vec3f::UnitX()).isZero());
    EXPECT_TRUE(AlbedoOf(MakeBsdf({}), Vec3f::UnitZ()).isZero());
}

TEST(AlbedoOf, IsFiniteWhereColoursAreNot) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Rgb albedo =
        AlbedoOf(MakeBsdf({LambertianReflection{Rgb(nan, -1, kInfinity)}}), Vec3f::UnitZ());
    EXPECT_EQ(albedo.x(), 0);
    EXPECT_EQ(albedo.y(), 0);
    EXPECT_EQ(albedo.z(), 1);
}

}  // namespace
}  // namespace lull::test
