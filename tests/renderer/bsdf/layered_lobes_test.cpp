// Checks glTF's lobes against integrals and by hand.
#include "renderer/bsdf/layered_lobes.h"

#include <gtest/gtest.h>

#include "tests/renderer/bsdf/lobe_examples.h"
#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull::test {
namespace {

// Returns the share of light from `wo` that a Bsdf scatters, from stratified samples.
Rgb SampledAlbedo(const Bsdf& bsdf, const Vec3f& wo) {
    constexpr int n = 200;
    Eigen::Array3d sum = Eigen::Array3d::Zero();
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) {
            const auto s =
                bsdf.Sample(wo, {(float(i) + 0.5f) / n, (float(j) + 0.5f) / n}, LobeSet::All);
            if (s) sum += (s->f * (std::abs(s->wi.z()) / s->pdf)).cast<double>();
        }
    return (sum / (n * n)).cast<float>();
}

TEST(GgxAlbedo, AgreesWithTheLobe) {
    for (const float alpha : {0.001f, 0.02f, 0.1f, 0.3f, 0.6f, 0.9f, 1.f})
        for (const double angle : {0., 20., 45., 70., 80., 85., 88.}) {
            const Vec3f wo = FromAngles(angle, 20);
            const GgxAlbedo albedo = DirectionalAlbedo(wo.z(), alpha);
            for (const float f0 : {0.f, 0.04f, 1.f}) {
                const Bsdf bsdf = MakeBsdf({MicrofacetReflection<SchlickInterface>{
                    Rgb(1, 1, 1), TrowbridgeReitz(alpha, alpha), SchlickInterface{f0}}});
                EXPECT_NEAR(albedo(f0, 1), SampledAlbedo(bsdf, wo).x(), 0.01)
                    << alpha << " " << angle << " " << f0;
            }
        }
}

TEST(GgxAlbedo, HasTheMeanOfItsDirections) {
    for (const float alpha : {0.01f, 0.2f, 0.5f, 1.f}) {
        double f0 = 0, f90 = 0;
        constexpr int n = 20000;
        for (int i = 0; i < n; ++i) {
            const double cosine = (i + 0.5) / n;
            const GgxAlbedo albedo = DirectionalAlbedo(float(cosine), alpha);
            f0 += 2 * cosine / n * albedo.ofF0;
            f90 += 2 * cosine / n * albedo.ofF90;
        }
        EXPECT_NEAR(MeanAlbedo(alpha).ofF0, f0, 2e-4);
        EXPECT_NEAR(MeanAlbedo(alpha).ofF90, f90, 2e-4);
    }
}

// Whatever the interface does not reflect, a white base does.
TEST(LayeredReflection, WithWhiteBaseReflectsEverything) {
    for (const float alpha : {0.001f, 0.1f, 0.4f, 1.f})
        for (const float f0 : {0.f, 0.04f, 0.3f})
            for (const double angle : {0., 40., 75., 87.}) {
                const Bsdf bsdf = MakeBsdf({LayeredReflection(Rgb(1, 1, 1), Rgb::Constant(f0), 1,
                                                              alpha, InterfaceAbove{f0, 1}, 0)});
                EXPECT_NEAR(SampledAlbedo(bsdf, FromAngles(angle)).x(), 1, 0.02)
                    << alpha << " " << f0 << " " << angle;
            }
}

// Seen from above: (1 - F)^2 c / pi / (1 - mean), and D F / 4 of the interface with D = 1 / pi.
TEST(LayeredReflection, HasHandComputedValues) {
    const Vec3f up(0, 0, 1);
    const Rgb c(0.5f, 0.25f, 0);
    const LayeredReflection lobe(c, Rgb::Constant(0.04f), 1, 1, InterfaceAbove{0.04f, 1}, 0);
    const double through = 1 - DirectionalAlbedo(1, 1)(0.04f, 1);
    const double left = 1 - MeanAlbedo(1)(0.04f, 1);
    const Rgb f = lobe.Evaluate(up, up).f;
    for (int i = 0; i < 3; ++i)
        EXPECT_NEAR(f[i], c[i] * through * through / left / kPi + 0.04 / kPi / 4, 1e-4);
    // A coat takes 4 % of the light on its way in and on its way out.
    const LayeredReflection coated(c, Rgb::Constant(0.04f), 1, 1, InterfaceAbove{0.04f, 1}, 1);
    EXPECT_NEAR(coated.Evaluate(up, up).f.x(), f.x() * 0.96 * 0.96, 1e-5);
}

TEST(ThinSpecular, DividesLightByFresnel) {
    const Bsdf bsdf = MakeBsdf(
        {ThinSpecular{Rgb(0.04f, 0.04f, 0.04f), 1, Rgb(1, 1, 1), InterfaceAbove{0.04f, 1}, 0}});
    for (const double angle : {0., 60., 85., 120.}) {
        const Vec3f wo = FromAngles(angle);
        EXPECT_NEAR(SampledAlbedo(bsdf, wo).x(), 1, 1e-3);
        const auto through = bsdf.Sample(wo, {0.999f, 0.5f}, LobeSet::All);
        ASSERT_TRUE(through);
        EXPECT_TRUE(through->isTransmission);
        EXPECT_TRUE(through->wi.isApprox(-wo));
    }
}

}  // namespace
}  // namespace lull::test
