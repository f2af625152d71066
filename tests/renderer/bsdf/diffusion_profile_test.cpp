// Tests the tabulated profiles of light below a surface: their integral, sampling and extremes.
#include "renderer/bsdf/subsurface.h"

#include <gtest/gtest.h>

#include "renderer/bsdf/fresnel.h"
#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull {
namespace {

// Integrates f(r) over the plane, from `low` to `high`, in steps that grow with r.
template <typename F>
double OverPlane(double low, double high, const F& f) {
    constexpr int kSteps = 4000;
    const double from = std::log1p(low * 1e3), to = std::log1p(high * 1e3);
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double t = from + (to - from) * (i + 0.5) / kSteps;
        const double r = std::expm1(t) * 1e-3, dr = (r + 1e-3) * (to - from) / kSteps;
        sum += 2 * std::numbers::pi * r * double(f(float(r))) * dr;
    }
    return sum;
}

// The fits are as good as this at the indices that solids have.
TEST(FresnelMoments, AreNearTheIntegrals) {
    for (const float eta : {1 / 1.8f, 1 / 1.33f, 1.f, 1.1f, 1.33f, 1.5f, 2.2f}) {
        double first = 0, second = 0;
        constexpr int kSteps = 10000;
        for (int i = 0; i < kSteps; ++i) {
            const float c = (float(i) + 0.5f) / kSteps;
            const double f = double(FresnelDielectric(c, 1 / eta)) / kSteps;
            first += f * double(c);
            second += f * double(c) * double(c);
        }
        EXPECT_NEAR(FresnelMoment1(eta), first, 0.003) << eta;
        EXPECT_NEAR(FresnelMoment2(eta), second, 0.003) << eta;
    }
}

TEST(DiffusionProfile, IntegratesToTheEffectiveAlbedo) {
    const DiffusionTable table(0.2f, 1.4f);
    for (const int i : {5, 30, 60, 99}) {
        const float a = table.albedo[i];
        const DiffusionProfile profile(table, Rgb::Constant(2 * (1 - a)), Rgb::Constant(2 * a));
        // The last radius is at 1.2^62 * 0.0025 / 2.
        const double albedo = OverPlane(0, 101.3, [&](float r) { return profile(r).x(); });
        EXPECT_NEAR(albedo, table.effectiveAlbedo[i], 0.005 * albedo) << a;
        EXPECT_GT(albedo, 0);
        EXPECT_LT(albedo, 1);
    }
    EXPECT_TRUE(std::is_sorted(table.effectiveAlbedo.begin(), table.effectiveAlbedo.end()));
}

// Returns Chandrasekhar's H(1) for isotropic scattering of the albedo (1960, section 38), by
// iterating its integral equation.
double ChandrasekharH(double albedo) {
    constexpr int kNodes = 200;
    std::array<double, kNodes> h;
    h.fill(1);
    const auto mu = [](int i) { return (i + 0.5) / kNodes; };
    const auto at = [&](double x) {
        double sum = 0;
        for (int i = 0; i < kNodes; ++i) sum += mu(i) * h[i] / (x + mu(i)) / kNodes;
        return 1 / (std::sqrt(1 - albedo) + 0.5 * albedo * sum);
    };
    for (int k = 0; k < 60; ++k) {
        std::array<double, kNodes> next;
        for (int i = 0; i < kNodes; ++i) next[i] = 0.5 * (h[i] + at(mu(i)));
        h = next;
    }
    return at(1);
}

// The albedo of a solid of index 1 under light along the normal is known; diffusion makes it 11 to
// 14 % brighter.
TEST(DiffusionProfile, IsNearTheExactAlbedoOfASolid) {
    const DiffusionTable table(0, 1);
    for (const float a : {0.5f, 0.9f, 0.98f}) {
        const double exact = 1 - ChandrasekharH(double(a)) * std::sqrt(1 - double(a));
        const DiffusionProfile profile(table, Rgb::Constant(1 - a), Rgb::Constant(a));
        const double albedo = OverPlane(0, 202, [&](float r) { return profile(r).x(); });
        EXPECT_NEAR(albedo, exact, 0.15 * exact) << a;
    }
}

TEST(DiffusionProfile, IsSampledByItsDensity) {
    const DiffusionTable table(0, 1.33f);
    const DiffusionProfile profile(table, Rgb(0.02f, 3, 0.4f), Rgb(5, 2, 0.1f));
    test::Random random(4);
    constexpr int kSamples = 20000, kBins = 16;
    for (int c = 0; c < 3; ++c) {
        std::array<double, kBins + 1> edges{};
        for (int i = 1; i < kBins; ++i) edges[i] = *profile.Sample(c, float(i) / kBins);
        edges[kBins] = *profile.Sample(c, kOneMinusEpsilon);
        std::array<int, kBins> counts{};
        for (int i = 0; i < kSamples; ++i) {
            const auto r = profile.Sample(c, random.Float());
            ASSERT_TRUE(r && *r >= 0);
            const auto bin = std::upper_bound(edges.begin(), edges.end(), double(*r));
            ++counts[std::clamp(int(bin - edges.begin()) - 1, 0, kBins - 1)];
        }
        for (int i = 0; i < kBins; ++i) {
            const double p =
                OverPlane(edges[i], edges[i + 1], [&](float r) { return profile.Pdf(c, r); });
            EXPECT_NEAR(p, 1. / kBins, 0.004) << c << ' ' << i;
            EXPECT_NEAR(counts[i], p * kSamples, 5 * std::sqrt(p * kSamples)) << c << ' ' << i;
        }
    }
}

TEST(BurleyProfile, IsSampledByItsDensityAndIntegratesToItsAlbedo) {
    const BurleyProfile profile(Rgb(0.2f, 0.5f, 0.9f), Rgb(0, 1, 40));
    EXPECT_EQ(profile(0.1f).x(), 0);
    EXPECT_FALSE(profile.Sample(0, 0.5f));
    EXPECT_EQ(profile.Pdf(0, 0.1f), 0);
    test::Random random(5);
    for (const int c : {1, 2}) {
        EXPECT_NEAR(OverPlane(0, 1e4, [&](float r) { return profile(r)[c]; }), c == 1 ? 0.5 : 0.9,
                    0.001);
        constexpr int kSamples = 20000;
        for (const float at : {0.05f, 0.2f, 0.6f, 8.f, 30.f}) {
            const double p =
                std::min(1., OverPlane(0, at, [&](float r) { return profile.Pdf(c, r); }));
            int count = 0;
            for (int i = 0; i < kSamples; ++i) count += *profile.Sample(c, random.Float()) < at;
            EXPECT_NEAR(count, p * kSamples, 5 * std::sqrt(p * (1 - p) * kSamples) + 1);
        }
    }
}

TEST(DiffusionProfile, FindsTheAlbedoOfScattering) {
    const DiffusionTable table(0, 1.33f);
    for (const int i : {1, 20, 50, 98})
        EXPECT_NEAR(AlbedoOfScattering(table, table.effectiveAlbedo[i]), table.albedo[i], 1e-4);
    EXPECT_EQ(AlbedoOfScattering(table, 0), 0);
    EXPECT_EQ(AlbedoOfScattering(table, -1), 0);
    EXPECT_NEAR(AlbedoOfScattering(table, 1), 1, 1e-3);
    EXPECT_EQ(AlbedoOfScattering(table, std::nanf("")), 0);
}

TEST(DiffusionProfile, StaysFinite) {
    for (const float eta : {1.f, 1.33f, 4.f})
        for (const float g : {-0.99f, 0.f, 0.99f}) {
            const DiffusionTable table(g, eta);
            for (const float s : {0.f, 1e-12f, 1.f, 1e6f, 1e15f}) {
                const DiffusionProfile profile(table, Rgb(0, s, 1), Rgb(s, 0, s));
                for (const float r : {0.f, 1e-20f, 1e-3f, 1.f, 1e20f}) {
                    EXPECT_TRUE((profile(r) >= 0).all() && IsFinite(profile(r))) << s << ' ' << r;
                    for (int c = 0; c < 3; ++c) {
                        EXPECT_GE(profile.Pdf(c, r), 0);
                        EXPECT_LT(profile.Pdf(c, r), kInfinity);
                    }
                }
                for (int c = 0; c < 3; ++c)
                    for (const float u : {0.f, 0.5f, kOneMinusEpsilon})
                        if (const auto r = profile.Sample(c, u)) {
                            EXPECT_GE(*r, 0);
                            EXPECT_LT(*r, kInfinity);
                        }
                EXPECT_FALSE(profile.Sample(1, 0.5f));  // it scatters nothing
            }
        }
}

}  // namespace
}  // namespace lull
