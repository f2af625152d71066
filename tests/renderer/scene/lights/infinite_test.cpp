#include "renderer/scene/lights/infinite.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numeric>

#include "renderer/base/math.h"
#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/renderer/scene/lights/light_scene.h"

namespace lull {
namespace {

using test::ChiSquarePValue;
using test::Random;

constexpr int kWidth = 6, kHeight = 4;

// Makes a map with a black row, a bright texel and colours, in its float form.
Image TestImage() {
    std::vector<float> texels;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            for (int c = 0; c < 3; ++c)
                texels.push_back(y == 2 ? 0 : float((x * 5 + y * 3 + c) % 7) + (x == 5 && !y) * 50);
    return {kWidth, kHeight, 3, texels};
}

// Returns what the density should be in proportion to, at the centre of a cell.
double CellWeight(const EnvironmentMap& map, int u, int v) {
    const Vec2f centre((u + 0.5f) / (2 * kWidth), (v + 0.5f) / (2 * kHeight));
    return std::sin(std::numbers::pi * (v + 0.5) / (2 * kHeight)) * Luminance(map.Radiance(centre));
}

// Samples have these probabilities by cell, and know their density.
void ExpectSamplesOf(const EnvironmentMap& map, const std::vector<double>& expected,
                     uint64_t seed) {
    constexpr int kSamples = 200000;
    Random random(seed);
    std::vector<int64_t> cells(expected.size());
    for (int k = 0; k < kSamples; ++k) {
        float pdf;
        const Vec2f st = map.Sample(random.Point(), &pdf);
        ASSERT_TRUE(st.minCoeff() >= 0 && st.maxCoeff() < 1);
        const int cell = int(st.y() * 2 * kHeight) * 2 * kWidth + int(st.x() * 2 * kWidth);
        ASSERT_NEAR(pdf, expected[cell] * expected.size(), 1e-4 * (1 + pdf));
        ++cells[cell];
    }
    EXPECT_GT(ChiSquarePValue(expected, cells, kSamples), 1e-3);
}

TEST(EnvironmentMap, DensityFollowsBrightnessAndSolidAngle) {
    const Rgb scale(1, 0.5f, 2);
    const EnvironmentMap map(TestImage(), scale);
    std::vector<double> expected;
    for (int v = 0; v < 2 * kHeight; ++v)
        for (int u = 0; u < 2 * kWidth; ++u) expected.push_back(CellWeight(map, u, v));
    const double total = std::accumulate(expected.begin(), expected.end(), 0.0);
    for (double& e : expected) e /= total;

    // The density is constant over each cell, up to its borders.
    for (int v = 0; v < 2 * kHeight; ++v)
        for (int u = 0; u < 2 * kWidth; ++u)
            for (const float d : {0.001f, 0.5f, 0.999f}) {
                const double e = expected[v * 2 * kWidth + u] * expected.size();
                EXPECT_NEAR(map.Pdf({(u + d) / (2 * kWidth), (v + d) / (2 * kHeight)}), e,
                            1e-5 * (1 + e));
            }

    ExpectSamplesOf(map, expected, 1);
}

// Compensated maps end at the poles, as all others have them; pbrt-v3's rows repeat.
TEST(EnvironmentMap, EndsAtThePoles) {
    for (const bool isCompensated : {false, true}) {
        const EnvironmentMap map({1, 2, 1, std::vector<float>{3, 1}}, Rgb::Ones(), isCompensated);
        EXPECT_FLOAT_EQ(map.Radiance({0.5f, 0}).x(), isCompensated ? 3 : 2);
        EXPECT_NEAR(map.Radiance({0.5f, 0.999f}).x(), isCompensated ? 1 : 2, 0.01);
        EXPECT_FLOAT_EQ(map.Radiance({0.5f, 0.5f}).x(), 2);
    }
}

// A compensated map takes the mean brightness off the density, but nothing that is bright away.
TEST(EnvironmentMap, CompensatedLeavesTheDarkToOthers) {
    const EnvironmentMap plain(TestImage(), Rgb::Ones()), map(TestImage(), Rgb::Ones(), true);
    std::vector<double> expected;
    int less = 0;
    for (int v = 0; v < 2 * kHeight; ++v)
        for (int u = 0; u < 2 * kWidth; ++u) {
            const Vec2f centre((u + 0.5f) / (2 * kWidth), (v + 0.5f) / (2 * kHeight));
            expected.push_back(map.Pdf(centre) / (4 * kWidth * kHeight));
            EXPECT_EQ(map.Pdf(centre) > 0, plain.Pdf(centre) > 0);
            less += map.Pdf(centre) < 0.5f * plain.Pdf(centre);
        }
    EXPECT_NEAR(std::accumulate(expected.begin(), expected.end(), 0.0), 1, 1e-5);
    EXPECT_GT(less, kWidth * kHeight);

    ExpectSamplesOf(map, expected, 6);

    // Where all is equally bright, nothing lies above the mean.
    const EnvironmentMap even({2, 1, 1, std::vector<float>{3, 3}}, Rgb::Ones(), true);
    EXPECT_NEAR(even.Pdf({0.2f, 0.5f}),
                EnvironmentMap({2, 1, 1, std::vector<float>{3, 3}}, Rgb::Ones()).Pdf({0.2f, 0.5f}),
                1e-4);
}

TEST(EnvironmentMap, FormsOfTexelsAgree) {
    std::vector<uint8_t> bytes;
    std::vector<Half> halves;
    std::vector<float> floats;
    for (int i = 0; i < kWidth * kHeight * 4; ++i) {
        bytes.push_back(uint8_t(i % 6 * 51));
        halves.emplace_back(float(i % 6) * 0.2f);
        floats.push_back(float(halves.back()));
    }
    const EnvironmentMap a({kWidth, kHeight, 4, bytes}, Rgb::Ones()),
        b({kWidth, kHeight, 4, halves}, Rgb::Ones()), c({kWidth, kHeight, 4, floats}, Rgb::Ones());
    const Vec2f st(0.3f, 0.99f);
    EXPECT_NEAR(a.Pdf(st), b.Pdf(st), 1e-3);
    EXPECT_FLOAT_EQ(b.Pdf(st), c.Pdf(st));
    EXPECT_LT((a.MeanTexel() - b.MeanTexel()).abs().maxCoeff(), 1e-3f);
    // Up to the rounding of what a compiler fuses of the interpolation, of texels up to 1.
    EXPECT_LT((b.Radiance(st) - c.Radiance(st)).abs().maxCoeff(), 1e-6f);
}

TEST(EnvironmentMap, HoldsExtremes) {
    float pdf;
    const EnvironmentMap black({2, 1, 1, std::vector<float>(2)}, Rgb::Ones());
    black.Sample({0.3f, 0.8f}, &pdf);
    EXPECT_FALSE(pdf > 0);
    EXPECT_EQ(black.Pdf({0.3f, 0.8f}), 0);

    const EnvironmentMap one({1, 1, 1, std::vector<float>{3}}, Rgb::Ones());
    EXPECT_NEAR(one.Pdf({0.1f, 0.9f}), 1, 1e-5);
    for (const float bright : {1e-40f, 1e9f, EnvironmentMap::kMaxTexel}) {
        std::vector<float> texels(100 * 50, bright * 1e-9f);
        texels[20 * 100 + 30] = bright;
        const EnvironmentMap sun({100, 50, 1, texels}, Rgb::Ones());
        Random random(7);
        for (int k = 0; k < 1000; ++k) {
            const Vec2f st = sun.Sample(random.Point(), &pdf);
            ASSERT_TRUE(st.minCoeff() >= 0 && st.maxCoeff() < 1);
            ASSERT_TRUE(pdf > 0 && std::isfinite(pdf));
            ASSERT_FLOAT_EQ(pdf, sun.Pdf(st));
            EXPECT_NEAR(st.x(), 0.305f, 0.01001f);
            EXPECT_NEAR(st.y(), 0.41f, 0.02001f);
        }
        EXPECT_TRUE(std::isfinite(sun.Pdf({0.305f, 0.41f})));
    }
}

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
            const Emitted found = LeAndPdf(test.scene->lights[0], Vec3f::Zero(), s->wi);
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
        EXPECT_GT(LeAndPdf(test.scene->lights[0], Vec3f::Zero(), kTowardsSun).pdf, 0);
        EXPECT_EQ(LeAndPdf(test.scene->lights[0], Vec3f::Zero(), -kTowardsSun).pdf, 0);
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
        EXPECT_HAS(ErrorOf([&] { LightScene scene(Sun(angle)); }), "\"angle\" is");
    }
}

}  // namespace
}  // namespace lull
