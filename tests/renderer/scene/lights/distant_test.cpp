#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/renderer/scene/lights/light_scene.h"

namespace lull {
namespace {

using test::Random;

std::string Sun(double angle) {
    return fmt::format(
        "LightSource \"distant\" \"rgb L\" [1 2 3] \"point from\" [.6 0 .8] "
        "\"point to\" [0 0 0] \"float angle\" [{}]",
        angle);
}
const Vec3f kTowardsSun(0.6f, 0, 0.8f);

// A surface has the irradiance that a parallel light of the same L would give it, at every angle at
// which all of the disc is above its horizon.
TEST(SunLight, HasTheIrradianceOfAParallelLight) {
    for (const double angle : {0.01, 0.526, 5., 60., 180.}) {
        const LightScene test(Sun(angle));
        constexpr int n = 64;
        Eigen::Array3d facing = Eigen::Array3d::Zero(), inclined = facing;
        int unknown = 0;
        for (int i = 0; i < n * n; ++i) {
            const auto s = test.scene->lights.Sample(
                0, Vec3f::Zero(), {(float(i % n) + 0.5f) / n, (float(i / n) + 0.5f) / n});
            ASSERT_TRUE(s && !s->isDelta && s->isAtInfinity);
            facing += (s->L * (s->wi.dot(kTowardsSun) / s->pdf)).cast<double>() / (n * n);
            inclined += (s->L * (s->wi.z() / s->pdf)).cast<double>() / (n * n);
            const Emitted found = LeAndPdf(test.scene->lights[0], s->wi);
            unknown += found.pdf != s->pdf || (found.L != s->L).any();
        }
        EXPECT_LE(unknown, angle < 0.1 ? n : 0) << angle;
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(facing[c], c + 1, 2e-3 * (c + 1)) << angle;
            if (angle < 90) {
                EXPECT_NEAR(inclined[c], 0.8 * (c + 1), 2e-3 * (c + 1)) << angle;
            }
        }
        const Rgb power = std::get<SunLight>(test.scene->lights[0]).Power();
        const LightScene parallel(Sun(0));
        EXPECT_TRUE(
            power.isApprox(std::get<DistantLight>(parallel.scene->lights[0]).Power(), 1e-6f));
    }
}

TEST(SunLight, IsADisc) {
    for (const double angle : {0.526, 20., 120.}) {
        const LightScene test(Sun(angle));
        const double radius = angle / 2 * std::numbers::pi / 180;
        // Rings and sectors of the same solid angle.
        test::SphereGrid grid{{{}, {}, kTowardsSun}, {0}, 8};
        CoordinateSystem(grid.frame.n, &grid.frame.s, &grid.frame.t);
        constexpr int kSamples = 64000;
        for (int i = 1; i <= 8; ++i)
            grid.theta.push_back(2 * std::asin(std::sin(radius / 2) * std::sqrt(i / 8.)));
        grid.theta.push_back(std::numbers::pi);
        std::vector<int> counts(size_t(grid.CellCount()));
        Random random(5);
        for (int k = 0; k < kSamples; ++k) {
            const auto s = test.scene->lights.Sample(0, Vec3f::Zero(), random.Point());
            ASSERT_TRUE(s);
            ++counts[size_t(grid.CellOf(s->wi))];
            EXPECT_NEAR(s->pdf * 2 * std::numbers::pi * (1 - std::cos(radius)), 1, 1e-4);
        }
        const double expected = kSamples / 64.;
        double chi2 = 0;
        int outside = 0;
        for (size_t i = 0; i < counts.size(); ++i)
            if (i < 64)
                chi2 += Sqr(counts[i] - expected) / expected;
            else
                outside += counts[i];
        EXPECT_GT(test::UpperGamma(63 / 2., chi2 / 2), 1e-3) << angle;
        EXPECT_LE(outside, kSamples / 1000) << angle;
        EXPECT_GT(LeAndPdf(test.scene->lights[0], kTowardsSun).pdf, 0);
        EXPECT_EQ(LeAndPdf(test.scene->lights[0], -kTowardsSun).pdf, 0);
    }
}

// The edge of a roof at a height of 1 leaves the share of the disc that shows beyond it.
TEST(SunLight, HasAPenumbra) {
    const double angle = 10, radius = std::tan(angle / 2 * std::numbers::pi / 180);
    const auto scene = SceneOf(WorldText(fmt::format(
        "LightSource \"distant\" \"point from\" [0 0 1] \"point to\" [0 0 0] \"float angle\" [{}]\n"
        "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" "
        "[0 -9 1  9 -9 1  9 9 1  0 9 1]",
        angle)));
    Random random(6);
    for (const double place : {-1.1, -0.9, -0.5, 0., 0.3, 0.8, 1.1}) {
        const Vec3f p(float(place * radius), 0, 0);
        int lit = 0;
        constexpr int kSamples = 20000;
        for (int k = 0; k < kSamples; ++k) {
            const auto s = scene->lights.Sample(0, p, random.Point());
            lit += !scene->accelerator.Occluded({p, s->wi, kInfinity});
        }
        const double x = std::clamp(place, -1., 1.);
        const double share = (std::acos(x) - x * std::sqrt(1 - x * x)) / std::numbers::pi;
        EXPECT_NEAR(lit / double(kSamples), share, 0.012) << place;
    }
}

TEST(SunLight, RefusesAnglesThatAreNone) {
    for (const double angle : {-1., 181.}) {
        const std::string error = ErrorOf([&] { LightScene scene(Sun(angle)); });
        EXPECT_TRUE(Contains(error, "\"angle\" is")) << error;
    }
}

}  // namespace
}  // namespace lull
