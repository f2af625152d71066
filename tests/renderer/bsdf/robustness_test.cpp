// Hunts for NaN, infinities and negative values in the corners. Every failure names its seed.
#include <gtest/gtest.h>

#include "tests/renderer/bsdf/lobe_examples.h"
#include "tests/renderer/bsdf/sphere_statistics.h"

namespace lull::test {
namespace {

// Returns a direction, often a nasty one.
Vec3f HardDirection(Random* random, const Vec3f& other) {
    const float tiny[] = {0, -0.f, 1e-6f, -1e-6f, 1e-3f, -1e-3f, 1e-20f, -1e-38f, 1e-45f};
    const float azimuth = 2 * kPi * random->Float(), s = std::sin(azimuth), c = std::cos(azimuth);
    const float z = tiny[random->Below(int(std::size(tiny)))];
    switch (random->Below(8)) {
        case 0:
            return {0, 0, random->Below(2) ? 1.f : -1.f};
        case 1:
            return Vec3f(c, s, z).normalized();
        case 2:
            return Vec3f(z * c, z * s, random->Below(2) ? 1.f : -1.f).normalized();
        case 3:
            return -other;
        case 4:
            return Vec3f(-other.x(), -other.y(), other.z());
        case 5:
            return (z * Vec3f(c, s, 0) - other).normalized();
        case 6:
            return Vec3f(z, c, s).normalized();
        default:
            return random->Direction();
    }
}

float HardNumber(Random* random) {
    const float numbers[] = {0, 0x1p-24f, 0.5f, 0.25f, kOneMinusEpsilon, 1e-30f};
    const int i = random->Below(12);
    return i < 6 ? numbers[i] : random->Float();
}

Lobe HardLobe(Random* random) {
    const float roughness[] = {1e-4f, 1e-3f, 0.01f, 0.3f, 1, 1.62f, 0};
    const float index[] = {1, 1.0000001f, 1.0001f, 1.5f, 1 / 1.5f, 0.5f, 3, 0.999999f};
    const float ax = roughness[random->Below(7)];
    const TrowbridgeReitz d(ax, random->Below(2) ? ax : roughness[random->Below(7)]);
    const float eta = index[random->Below(8)];
    const Rgb c(random->Float(), 1, 0), e(0.01f + 3 * random->Float(), 1, 0);
    switch (random->Below(17)) {
        case 0:
            return LambertianReflection{c};
        case 1:
            return LambertianTransmission{c};
        case 2:
            return OrenNayar(c, 90 * random->Float() + 1e-3f);
        case 3:
            return DielectricReflection{c, d, {eta}};
        case 4:
            return ConductorReflection{c, d, {e, Rgb(5 * random->Float(), 0, 0)}};
        case 5:
            return MicrofacetTransmission{c, d, eta};
        case 6:
            return SpecularReflection<PerfectMirror>{c, {}};
        case 7:
            return SpecularReflection<DielectricInterface>{c, {eta}};
        case 8:
            return SpecularReflection<ConductorInterface>{c, {e, c}};
        case 9:
            return SpecularTransmission{c, eta};
        case 10:
            return FresnelSpecular{c, c, eta};
        case 11:
            return DisneyDiffuse{c, random->Float(), DisneyDiffuse::Part(random->Below(5))};
        case 12:
            return DisneyReflection{c, d, {e, random->Float(), eta}};
        case 13:
            return DisneyTransmission{c, d, eta};
        case 14:
            return DisneyClearcoat{c, Lerp(random->Float(), 0.1f, 0.001f)};
        case 15:
            return HairLobe(c, 2 * random->Float() - 1, eta, ax, random->Float(), 3);
        default:
            return FresnelBlend{c, Rgb(1, random->Float(), 0), d};
    }
}

void ExpectSound(const Rgb& f, float pdf) {
    EXPECT_TRUE(IsFinite(f) && (f >= 0).all()) << f.transpose();
    EXPECT_TRUE(std::isfinite(pdf) && pdf >= 0) << pdf;
}

TEST(Robustness, LobesAreSoundForAnyDirections) {
    for (uint64_t seed = 0; seed < 300'000; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const Vec3f wo = HardDirection(&random, Vec3f::UnitZ());
        const Vec3f wi = HardDirection(&random, wo);
        VisitLobe(HardLobe(&random), [&](const auto& lobe) {
            if constexpr (!std::decay_t<decltype(lobe)>::kIsSpecular) {
                const BsdfValue v = lobe.Evaluate(wo, wi);
                ExpectSound(v.f, v.pdf);
            }
        });
        if (testing::Test::HasFailure()) return;
    }
}

TEST(Robustness, BsdfsAreSoundForAnyDirections) {
    for (uint64_t seed = 0; seed < 300'000; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        Frame frame{Vec3f::UnitX(), Vec3f::UnitY(), Vec3f::UnitZ()};
        if (random.Below(2)) {
            frame.n = random.Direction();
            CoordinateSystem(frame.n, &frame.s, &frame.t);
        }
        const Vec3f ng =
            random.Below(2) ? frame.n : Vec3f((frame.n + 0.5f * random.Direction()).normalized());
        Bsdf bsdf(frame, ng);
        for (int count = 1 + random.Below(Bsdf::kMaxLobes); count > 0; --count)
            bsdf.Add(HardLobe(&random));
        const Vec3f wo = HardDirection(&random, frame.n), wi = HardDirection(&random, wo);
        const LobeSet set = random.Below(2) ? LobeSet::All : LobeSet::NonSpecular;

        const BsdfValue v = bsdf.Evaluate(wo, wi, set);
        ExpectSound(v.f, v.pdf);
        const float u = HardNumber(&random);
        if (const auto s = bsdf.Sample(wo, {u, HardNumber(&random)}, set)) {
            ExpectSound(s->f, s->pdf);
            EXPECT_GT(s->pdf, 0);
            EXPECT_FALSE(IsBlack(s->f));
            EXPECT_NEAR(s->wi.norm(), 1, 1e-5f);
        }
        if (testing::Test::HasFailure()) return;
    }
}

// Weights of samples stay bounded at any angle: nothing that is rare is bright.
TEST(Robustness, WeightsOfSamplesAreBounded) {
    for (uint64_t seed = 0; seed < 100'000; ++seed) {
        SCOPED_TRACE(seed);
        Random random(seed);
        const Lobe lobe = HardLobe(&random);
        if (std::holds_alternative<FresnelBlend>(lobe)) continue;     // has no masking
        if (std::holds_alternative<DisneyClearcoat>(lobe)) continue;  // samples without its masking
        if (std::holds_alternative<HairLobe>(lobe)) continue;  // blue alone is luminance / 0.07
        // Grows without bounds where both directions graze.
        if (const auto* d = std::get_if<DisneyDiffuse>(&lobe))
            if (d->part == DisneyDiffuse::Part::FakeSubsurface) continue;
        const Bsdf bsdf = MakeBsdf({lobe});
        const Vec3f wo = HardDirection(&random, Vec3f::UnitZ());
        const auto s = bsdf.Sample(wo, random.Point(), LobeSet::All);
        if (!s) continue;
        // Grows with the tangent of the smaller angle: without bounds where both directions graze.
        if (std::holds_alternative<OrenNayar>(lobe) &&
            std::max(std::abs(wo.z()), std::abs(s->wi.z())) < 0.1f)
            continue;
        // Colours are at most 1 and refraction scales by at most 3^2; Oren-Nayar reaches 1.6.
        EXPECT_LT(s->f.maxCoeff() * std::abs(s->wi.z()) / s->pdf, 9.5f);
        if (testing::Test::HasFailure()) return;
    }
}

}  // namespace
}  // namespace lull::test
