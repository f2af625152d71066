// Checks glTF's lobes against integrals and by hand.
#include "renderer/bsdf/layered_lobes.h"

#include <gtest/gtest.h>

#include "tests/renderer/bsdf/lobe_examples.h"
#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull::test {
namespace {

// Returns the share of light from `wo` that a Bsdf scatters, from stratified samples.
Rgb SampledAlbedo(const Bsdf& bsdf, const Vec3f& wo) {
    constexpr int n = 100;
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
    // A coat takes 4 % of the light, by the direction of view.
    const LayeredReflection coated(c, Rgb::Constant(0.04f), 1, 1, InterfaceAbove{0.04f, 1}, 1);
    EXPECT_NEAR(coated.Evaluate(up, up).f.x(), f.x() * 0.96, 1e-5);
}

// Of light that comes and goes at 45 degrees to either side: D / 4 over the product of the cosines,
// 1/2, times Schlick's reflectance at 45 degrees, and once through the coat.
TEST(CoatedReflection, HasHandComputedValues) {
    const Rgb f0(0.5f, 0.25f, 0);
    const MicrofacetReflection<CoatedInterface> lobe{
        Rgb(1, 1, 1), TrowbridgeReitz(0.4f, 0.2f), {f0, 1, 0.5f}};
    const double cosine = std::sqrt(0.5), weight = std::pow(1 - cosine, 5);
    for (const double azimuth : {0., 90.}) {
        const double alpha = azimuth == 0 ? 0.4 : 0.2;
        const Vec3f wo = FromAngles(45, azimuth), wi = FromAngles(45, azimuth + 180);
        const double d = 1 / (kPi * 0.4 * 0.2);
        const double g = 2 / (1 + std::sqrt(1 + alpha * alpha));  // G1 by the tangent, 1
        const double both = 1 / (2 / g - 1);                      // correlated: 1 / (1 + 2 Lambda)
        const double through = 1 - (0.02 + (0.5 - 0.02) * weight);
        const Rgb f = lobe.Evaluate(wo, wi).f;
        for (int i = 0; i < 3; ++i)
            EXPECT_NEAR(f[i], d / 4 / 0.5 * both * (f0[i] + weight * (1 - f0[i])) * through, 1e-4)
                << azimuth;
    }
}

// The highlight is wide along the axis of the larger alpha.
TEST(CoatedReflection, StretchesAlongTheRougherAxis) {
    const MicrofacetReflection<CoatedInterface> lobe{
        Rgb(1, 1, 1), TrowbridgeReitz(0.5f, 0.1f), {Rgb(Rgb::Ones()), 1, 0}};
    const auto at = [&](double azimuth) {
        return lobe.Evaluate(FromAngles(20, azimuth), Vec3f::UnitZ()).f.x();
    };
    EXPECT_GT(at(0), 3 * at(90));
}

// Steps are narrow where light grazes, as the lobe is.
TEST(SheenAlbedo, AgreesWithTheLobe) {
    for (const float alpha : {0.01f, 0.04f, 0.2f, 0.6f, 1.f})
        for (const double angle : {0., 30., 60., 75., 85., 88., 89.99}) {
            const Vec3f wo = FromAngles(angle);
            const CharlieSheen lobe{Rgb(1, 1, 1), alpha};
            constexpr int kCosines = 300, kAzimuths = 100;
            double sum = 0;
            for (int i = 0; i < kCosines; ++i)
                for (int j = 0; j < kAzimuths; ++j) {
                    const double u = (i + 0.5) / kCosines, cosine = u * u;
                    const Vec3f wi =
                        FromAngles(std::acos(cosine) * 180 / kPi, 180 * (j + 0.5) / kAzimuths);
                    sum += lobe.Evaluate(wo, wi).f.x() * cosine * 2 * u;
                }
            EXPECT_NEAR(SheenAlbedo(wo.z(), alpha), sum * 2 * kPi / (kCosines * kAzimuths), 0.04)
                << alpha << " " << angle;
        }
}

// At alpha 1 and 45 degrees to either side of the normal, at right angles in azimuth: the half
// vector has cosine 1/2^0.5 / (0.75)^0.5. The fit's numbers are those of the paper.
TEST(CharlieSheen, HasHandComputedValues) {
    const auto l = [](double x) {
        return 21.5473 / (1 + 3.82987 * std::pow(x, 0.19823)) - 1.9776 * x - 4.32054;
    };
    const double cosine = std::sqrt(0.5);
    const double lambda = std::exp(2 * l(0.5) - l(1 - cosine));
    const double sine = std::sqrt(1 - 0.5 / 0.75);
    const double expected = 3 * sine / (2 * kPi) / (4 * 0.5 * (1 + 2 * lambda));
    const CharlieSheen lobe{Rgb(1, 0.5f, 0), 1};
    const Rgb f = lobe.Evaluate(FromAngles(45, 0), FromAngles(45, 90)).f;
    EXPECT_NEAR(f.x(), expected, 1e-5);
    EXPECT_NEAR(f.y(), expected / 2, 1e-5);
}

// A normal map moves light of one side of the surface to that of the other: none is made.
TEST(CharlieSheen, ReflectsAsMuchWhereTheNormalIsTilted) {
    Random random(45);
    for (const float tilt : {0.f, 30.f, 60.f})
        for (const float angle : {0.f, 50.f, 85.f}) {
            const Vec3f normal = FromAngles(tilt), wo = FromAngles(angle, 180);
            const Bsdf bsdf = Tilted(CharlieSheen{Rgb(1, 1, 1), 0.25f}, normal);
            double sum = 0;
            constexpr int kCount = 100000;
            for (int i = 0; i < kCount; ++i) {
                const Vec3f wi = random.Direction();
                sum +=
                    double(bsdf.Evaluate(wo, wi, LobeSet::All).f.x() * std::abs(wi.dot(normal))) *
                    4 * kPi / kCount;
            }
            EXPECT_NEAR(sum, SheenAlbedo(std::abs(wo.dot(normal)), 0.25f), 0.05)
                << tilt << " " << angle;
        }
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

// What goes straight through is what samples transmit, and nothing after it has been blocked.
TEST(ThinSpecular, LetsTheShareOfItsSamplesThrough) {
    Bsdf bsdf = MakeBsdf({LambertianReflection{Rgb(0.2f, 0.2f, 0.2f)},
                          Scaled(ThinSpecular{Rgb(0.02f, 0.02f, 0.02f), 0.5f, Rgb(0.5f, 0.3f, 0.1f),
                                              InterfaceAbove{0.04f, 1}, 0.5f},
                                 Rgb(0.9f, 0.8f, 0.7f))});
    for (const double angle : {0., 40., 100., 175.}) {
        const Vec3f wo = FromAngles(angle, 20);
        const auto transmitted = [&] {
            Rgb sum = Rgb::Zero();
            constexpr int n = 1000;
            for (int i = 0; i < n; ++i) {
                const auto s = bsdf.Sample(wo, {(float(i) + 0.5f) / n, 0.5f}, LobeSet::All);
                if (!s || !s->isTransmission) continue;
                EXPECT_LT((s->wi + wo).norm(), 1e-6f);
                sum += s->f * (std::abs(s->wi.z()) / (s->pdf * n));
            }
            return sum;
        };
        const Rgb through = bsdf.StraightThrough(wo);
        EXPECT_LT((transmitted() - through).abs().maxCoeff(), 1e-3f) << angle;
        EXPECT_GT(through.minCoeff(), 0.02f) << angle;
        Bsdf blocked = bsdf;
        blocked.BlockStraight();
        EXPECT_TRUE(IsBlack(blocked.StraightThrough(wo)));
        EXPECT_EQ(blocked.LobeCount(LobeSet::All), 2);
    }
}

}  // namespace
}  // namespace lull::test
