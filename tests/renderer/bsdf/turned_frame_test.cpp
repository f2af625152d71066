// Shading normals that the surface does not have: no light goes through, and none is lost.
#include <gtest/gtest.h>

#include "renderer/bsdf/bsdf.h"
#include "tests/renderer/bsdf/lobe_examples.h"
#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull::test {
namespace {

const Rgb kNoLoss(1, 1, 1);

Lobe Metal(float roughness) {
    const float alpha = Sqr(roughness);
    if (roughness == 0) return ThinSpecular{kNoLoss, 1, Rgb(Rgb::Zero()), InterfaceAbove{0, 0}, 0};
    return LayeredReflection(Rgb::Zero(), kNoLoss, 1, alpha, InterfaceAbove{0, 0}, 0);
}

// Returns the share of uniform light that is scattered to wo.
float Reflectance(const Bsdf& bsdf, const Vec3f& wo, Random& random, int count) {
    double sum = 0;
    for (int i = 0; i < count; ++i) {
        const auto s = bsdf.Sample(wo, random.Point(), LobeSet::All);
        if (!s) continue;
        EXPECT_GT(s->wi.z() * wo.z(), 0);
        sum += double(s->f.y() * std::abs(s->wi.dot(bsdf.Shading().n)) / s->pdf);
    }
    return float(sum / count);
}

// Over angles of the view, roughness, and strengths of the map: a furnace of radiance 1.
TEST(TurnedFrame, MetalsReflectAllLight) {
    Random random(41);
    for (const float roughness : {0.f, 0.02f, 0.04f, 0.1f, 0.2f, 0.3f})
        for (const float tilt : {0.f, 20.f, 45.f, 60.f})
            for (const float angle : {0.f, 30.f, 60.f, 75.f, 85.f})
                for (const float azimuth : {0.f, 90.f, 180.f}) {
                    const Bsdf bsdf = Tilted(Metal(roughness), FromAngles(tilt));
                    const Vec3f wo = FromAngles(angle, azimuth);
                    const float all = Reflectance(bsdf, wo, random, roughness == 0 ? 1 : 2000);
                    // What the surface itself, without a map, loses by one scattering.
                    const float flat = Reflectance(Tilted(Metal(roughness), Vec3f::UnitZ()), wo,
                                                   random, roughness == 0 ? 1 : 2000);
                    const std::string what = fmt::format("roughness {} tilt {} view {} {}",
                                                         roughness, tilt, angle, azimuth);
                    EXPECT_GT(all, std::min(flat, 0.95f) - 0.06f) << what;
                    EXPECT_LT(all, 1.04f) << what;
                    EXPECT_NEAR(AlbedoOf(bsdf, wo).y(), all, 0.12f) << what;
                }
}

// Neither do bases below a rough interface get more, or less, by light that is sampled.
TEST(TurnedFrame, BasesReflectAllLight) {
    Random random(44);
    for (const float alpha : {0.1f, 1.f})
        for (const float tilt : {0.f, 30.f, 50.f})
            for (const float azimuth : {0.f, 90.f, 180.f}) {
                const Lobe lobe = LayeredReflection(kNoLoss, Rgb::Constant(0.04f), 1, alpha,
                                                    InterfaceAbove{0.04f, 1}, 0);
                const Bsdf bsdf = Tilted(lobe, FromAngles(tilt));
                const Vec3f wo = FromAngles(50, azimuth);
                double f = 0;
                constexpr int kCount = 200000;
                for (int i = 0; i < kCount; ++i) {
                    const Vec3f wi = random.Direction();
                    f += double(bsdf.Evaluate(wo, wi, LobeSet::All).f.y() *
                                std::abs(wi.dot(bsdf.Shading().n))) *
                         4 * kPi / kCount;
                }
                EXPECT_NEAR(f, 1, 0.06) << alpha << " " << tilt << " " << azimuth;
            }
}

// Sampling finds as much as the values say, and the densities are those of the samples.
TEST(TurnedFrame, SamplesAgreeWithValues) {
    Random random(42);
    for (const float tilt : {30.f, 60.f})
        for (const float angle : {40.f, 70.f, 85.f}) {
            const Bsdf bsdf = Tilted(Metal(0.5f), FromAngles(tilt));
            const Vec3f wo = FromAngles(angle, 180);
            double f = 0, pdf = 0;
            constexpr int kCount = 200000;
            for (int i = 0; i < kCount; ++i) {
                const Vec3f wi = random.Direction();
                const BsdfValue v = bsdf.Evaluate(wo, wi, LobeSet::All);
                if (wi.z() < 0) {
                    EXPECT_EQ(v.f.y(), 0);
                }
                if (v.pdf > 0)
                    f += double(v.f.y() * std::abs(wi.dot(bsdf.Shading().n))) * 4 * kPi / kCount;
                if (wi.z() > 0) pdf += double(v.pdf) * 4 * kPi / kCount;
            }
            EXPECT_NEAR(f, Reflectance(bsdf, wo, random, 20000), 0.03);
            EXPECT_NEAR(pdf, 1, 0.08);  // without those that end below all the same
        }
}

// No lobe of an opaque material lets light through, whatever its normal, nor do mirrors.
TEST(TurnedFrame, OpaqueLobesKeepLightOnTheirSide) {
    Random random(43);
    std::vector<NamedLobe> lobes = SpreadLobes();
    for (const NamedLobe& l : SpecularLobes()) lobes.push_back(l);
    for (const NamedLobe& l : lobes) {
        const bool transmits = VisitLobe(l.lobe, [](const auto& lobe) { return lobe.kTransmits; });
        if (transmits) continue;
        for (int i = 0; i < 500; ++i) {
            const Bsdf bsdf =
                Tilted(l.lobe, FromAngles(85 * random.Point().x(), 360 * random.Point().y()));
            const Vec3f wo = random.Direction(), wi = random.Direction();
            const auto s = bsdf.Sample(wo, random.Point(), LobeSet::All);
            if (s) {
                EXPECT_GT(s->wi.z() * wo.z(), 0) << l.name;
            }
            if (wi.z() * wo.z() < 0) {
                EXPECT_EQ(bsdf.Evaluate(wo, wi, LobeSet::All).f.sum(), 0) << l.name;
            }
        }
    }
}

// A mirror's direction just above the surface stays; one below comes up to it continuously.
TEST(TurnedFrame, MovesWithTheNormal) {
    const Vec3f wo = FromAngles(70, 180);
    Vec3f last = Vec3f::Zero();
    for (float tilt = 0; tilt < 80; tilt += 0.25f) {
        const auto s = Tilted(Metal(0), FromAngles(tilt)).Sample(wo, {0.5f, 0.5f}, LobeSet::All);
        ASSERT_TRUE(s) << tilt;
        EXPECT_GT(s->wi.z(), 0);
        if (tilt > 0) {
            EXPECT_LT((s->wi - last).norm(), 0.03f) << tilt;
        }
        last = s->wi;
    }
}

}  // namespace
}  // namespace lull::test
