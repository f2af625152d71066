// Tests the scattering of hair: that nothing is lost without absorption, and that it is sampled
// with the density claimed.
#include "renderer/bsdf/hair_lobe.h"

#include <gtest/gtest.h>

#include "tests/renderer/bsdf/lobe_examples.h"
#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull::test {
namespace {

// Averages f |cos| over all directions of light, for a hair lit and seen along random ones.
TEST(Hair, LosesNothingWithoutAbsorption) {
    Random random(1);
    for (const float betaM : {0.1f, 0.4f, 0.8f, 1.f})
        for (const float betaN : {0.1f, 0.4f, 1.f}) {
            SampleMean mean;
            const Vec3f wo = random.Direction();
            for (int i = 0; i < 60000; ++i) {
                const HairLobe hair(Rgb::Zero(), -1 + 2 * random.Float(), 1.55f, betaM, betaN, 0);
                const Vec3f wi = random.Direction();
                mean.Add(hair.Evaluate(wo, wi).f.y() * std::abs(wi.z()) * 4 * kPi);
            }
            EXPECT_NEAR(mean.Value(), 1, 4.5 * mean.Error() + 0.01) << betaM << " " << betaN;
        }
}

// By importance: every sample has weight 1.
TEST(Hair, SamplesHaveWeightOneWithoutAbsorption) {
    Random random(2);
    for (int i = 0; i < 5000; ++i) {
        const HairLobe hair(Rgb::Zero(), -1 + 2 * random.Float(), 1.55f,
                            0.1f + 0.9f * random.Float(), 0.1f + 0.9f * random.Float(),
                            10 * random.Float());
        const Vec3f wo = random.Direction();
        Vec3f wi;
        ASSERT_TRUE(hair.Sample(wo, random.Point(), &wi));
        ASSERT_NEAR(wi.norm(), 1, 1e-4);
        const BsdfValue v = hair.Evaluate(wo, wi);
        ASSERT_NEAR(v.f.y() * std::abs(wi.z()) / v.pdf, 1, 1e-3) << i;
    }
}

TEST(Hair, FollowsItsDensity) {
    uint64_t seed = 100;
    for (const float h : {-0.9f, 0.f, 0.6f})
        for (const float beta : {0.6f, 0.9f})
            for (const double angle : {20.0, 80.0, 130.0}) {
                const HairLobe hair(Rgb(0.1f, 0.5f, 2), h, 1.55f, beta, beta, 3);
                const Vec3f wo = FromAngles(angle, 37);
                const Bsdf bsdf = MakeBsdf({hair});
                constexpr int kSamples = 20000;  // 12 bits a number show with more
                double total;
                const double p = PValueOf(
                    EvenGrid(24, 32),
                    [&](const Vec3f& wi) { return double(hair.Evaluate(wo, wi).pdf); }, kSamples,
                    ++seed,
                    [&](Random& random) {
                        return SampleSpread(bsdf, wo, random.Point(), LobeSet::All);
                    },
                    &total);
                EXPECT_NEAR(total, 1, 0.01) << h << " " << beta << " " << angle;
                EXPECT_GT(p, 1e-5) << h << " " << beta << " " << angle;
            }
}

TEST(Hair, StaysFiniteAtItsLimits) {
    Random random(3);
    for (const float h : {-1.f, 0.f, 1.f, 2.f})
        for (const float beta : {0.f, 1.f, 7.f})
            for (const float eta : {0.5f, 1.f, 1.55f, 100.f})
                for (const float sigma : {0.f, 1.f, 1e10f})
                    for (int i = 0; i < 20; ++i) {
                        const HairLobe hair(Rgb(sigma, sigma, 0), h, eta, beta, beta, 5);
                        Vec3f wo = random.Direction(), wi = random.Direction();
                        if (i % 5 == 0) wo = Vec3f::UnitX();
                        if (i % 7 == 0) wi = -Vec3f::UnitX();
                        const BsdfValue v = hair.Evaluate(wo, wi);
                        ASSERT_TRUE(!v.f.isNaN().any() && (v.f >= 0).all()) << h << beta << eta;
                        ASSERT_TRUE(v.pdf >= 0) << h << " " << beta << " " << eta;
                        ASSERT_TRUE(hair.Sample(wo, random.Point(), &wi));
                        ASSERT_TRUE(wi.allFinite()) << h << " " << beta << " " << eta;
                    }
}

TEST(Hair, AbsorbsItsColour) {
    EXPECT_NEAR(HairAbsorption(1, 2).x(), 0.419 + 2 * 0.187, 1e-5);
    EXPECT_NEAR(HairAbsorptionOfColor(Rgb(1, 1, 1), 0.3f).x(), 0, 1e-6);
    EXPECT_GT(HairAbsorptionOfColor(Rgb(0.1f, 0.5f, 0.9f), 0.3f).x(),
              HairAbsorptionOfColor(Rgb(0.1f, 0.5f, 0.9f), 0.3f).y());
    EXPECT_TRUE(HairAbsorptionOfColor(Rgb(0, 0, 0), 0.3f).allFinite());
}

}  // namespace
}  // namespace lull::test
