#include "renderer/bsdf/fresnel.h"

#include <gtest/gtest.h>

#include "tests/renderer/bsdf/reference_lobes.h"
#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull::test {
namespace {

Rgb Conductor(float cosI, const Rgb& eta, const Rgb& k) { return ConductorInterface(eta, k)(cosI); }

TEST(FresnelDielectric, HasTextbookValues) {
    EXPECT_NEAR(FresnelDielectric(1, 1.5f), 0.04f, 1e-7f);
    EXPECT_NEAR(FresnelDielectric(-1, 1.5f), 0.04f, 1e-7f);
    // At Brewster's angle, tan = 1.5, only one polarisation is left: ((n^2 - 1) / (n^2 + 1))^2 / 2.
    EXPECT_NEAR(FresnelDielectric(1 / std::sqrt(3.25f), 1.5f), 0.0739645f, 1e-6f);
    EXPECT_EQ(FresnelDielectric(0, 1.5f), 1);
    // From the dense side beyond asin(1 / 1.5) = 41.8 degrees.
    EXPECT_EQ(FresnelDielectric(-std::cos(42 * kPi / 180), 1.5f), 1);
    EXPECT_LT(FresnelDielectric(-std::cos(41 * kPi / 180), 1.5f), 1);
    EXPECT_NEAR(FresnelDielectric(0.3f, 1), 0, 1e-12f);
}

TEST(FresnelDielectric, AgreesWithAmplitudes) {
    Random random(11);
    for (int i = 0; i < 10000; ++i) {
        const float eta = 0.4f + 2 * random.Float(), c = 2 * random.Float() - 1;
        const float n = c > 0 ? eta : 1 / eta;
        // Skips what rounding can move across the critical angle.
        if (std::abs(std::sqrt(1 - c * c) - n) < 1e-4f) continue;
        EXPECT_NEAR(FresnelDielectric(c, eta), ReferenceDielectric(c, eta), 2e-5)
            << c << " " << eta;
    }
}

TEST(FresnelConductor, AgreesWithAmplitudes) {
    Random random(12);
    for (int i = 0; i < 10000; ++i) {
        const float c = random.Float();
        const Rgb eta(0.1f + 3 * random.Float(), 0.05f + random.Float(), 1);
        const Rgb k(0.05f + 5 * random.Float(), 0.05f + 10 * random.Float(),
                    0.05f + random.Float());
        const Rgb f = Conductor(c, eta, k);
        for (int j = 0; j < 3; ++j)
            EXPECT_NEAR(f[j], ReferenceFresnel(c, std::complex<double>(eta[j], k[j])), 1e-4)
                << c << " " << eta[j] << " " << k[j];
    }
}

TEST(FresnelConductor, IsFiniteForDegenerateIndices) {
    for (float c : {0.f, 1e-6f, 0.5f, 1.f})
        for (float k : {0.f, 1e-6f, 1.f, 100.f}) {
            const Rgb f = Conductor(c, Rgb(0, 1, 1e-6f), Rgb::Constant(k));
            EXPECT_TRUE(IsFinite(f) && (f >= 0).all() && (f <= 1 + 1e-5f).all()) << c << " " << k;
        }
}

TEST(FresnelSchlick, IsExactAtBothEnds) {
    const Rgb r0(0.04f, 0.5f, 1);
    EXPECT_TRUE((FresnelSchlick(r0, 1) == r0).all());
    EXPECT_TRUE((FresnelSchlick(r0, 0) == 1).all());
    EXPECT_NEAR(FresnelSchlick(r0, 0.5f).x(), 0.04f + 0.96f / 32, 1e-7f);
}

TEST(Refract, FollowsSnell) {
    Random random(13);
    for (int i = 0; i < 10000; ++i) {
        const Vec3f n = random.Direction();
        const Vec3f w = FaceForward(random.Direction(), n);
        const float ratio = 0.4f + 2 * random.Float();
        const float sinI = w.cross(n).norm();
        Vec3f t = Vec3f::Zero();
        if (std::abs(sinI * ratio - 1) < 1e-4f) continue;
        ASSERT_EQ(Refract(w, n, ratio, &t), sinI * ratio < 1);
        if (sinI * ratio >= 1) continue;
        EXPECT_NEAR(t.norm(), 1, 1e-5f);
        EXPECT_LT(t.dot(n), 0);
        EXPECT_LT((t.cross(n) + ratio * w.cross(n)).norm(), 1e-5f);
    }
}

}  // namespace
}  // namespace lull::test
