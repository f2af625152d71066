// Tests bilerp, uv, dots, windy and wrinkled textures. That noise is pbrt-v3's is tested elsewhere.
#include <gtest/gtest.h>

#include "renderer/scene/textures/noise.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/scene/textures/texture_builder.h"

namespace lull {
namespace {

constexpr bool kFloat = false, kSpectrum = true;

TEST(Bilerp, InterpolatesCorners) {
    TextureBuilder b;
    const int plain = b.Add(kFloat, "bilerp", {});
    const int colored =
        b.Add(kSpectrum, "bilerp",
              {Color("v00", {1, 0, 0}), Color("v01", {0, 1, 0}), Color("v10", {0, 0, 1}),
               Grey("v11", 2), Float("uscale", 2), Float("vdelta", 0.5f)});
    const TextureTable table = b.Build();
    EXPECT_EQ(b.warnings.Total(), 0);
    // By default the value is t.
    EXPECT_FLOAT_EQ(table.Evaluate(b.Float(table, plain), At(0.3f, 0.8f)), 0.8f);
    // s = 0.5, t = 0.75.
    const Rgb c = table.Evaluate(b.Spectrum(table, colored), At(0.25f, 0.25f));
    EXPECT_NEAR(c.x(), 0.125 + 0.75, 1e-6);
    EXPECT_NEAR(c.y(), 0.375 + 0.75, 1e-6);
    EXPECT_NEAR(c.z(), 0.125 + 0.75, 1e-6);
    EXPECT_EQ(table.Needs(b.Spectrum(table, colored)), kNeedsUv);
}

TEST(Uv, ShowsFractions) {
    TextureBuilder b;
    const int uv = b.Add(kSpectrum, "uv", {Float("uscale", 3)});
    const TextureTable table = b.Build();
    const Rgb c = table.Evaluate(b.Spectrum(table, uv), At(0.75f, -0.25f));
    EXPECT_NEAR((c - Rgb(0.25f, 0.75f, 0)).abs().maxCoeff(), 0, 1e-6);
    // pbrt-v3 has no float one.
    TextureBuilder other;
    other.Add(kFloat, "uv", {});
    EXPECT_NE(ErrorOf([&] { other.Build(); }), "");
}

// Some squares have a dot, which covers the middle of its square and none of the corners, and shows
// the texture called "outside" as it does in pbrt-v3.
TEST(Dots, LieInSomeSquares) {
    TextureBuilder b;
    const int dots = b.Add(kFloat, "dots", {Float("inside", 2), Float("outside", 5)});
    const TextureTable table = b.Build();
    EXPECT_EQ(b.warnings.Total(), 0);
    const FloatTexture texture = b.Float(table, dots);
    int count = 0;
    for (int i = -10; i < 10; ++i)
        for (int j = -10; j < 10; ++j) {
            const float s = float(i), t = float(j);
            EXPECT_EQ(table.Evaluate(texture, At(s + 0.49f, t + 0.49f)), 2);
            const bool hasDot = Noise(Vec3f(s + 0.5f, t + 0.5f, 0.5f)) > 0;
            EXPECT_EQ(table.Evaluate(texture, At(s, t)), hasDot ? 5 : 2);
            count += hasDot;
        }
    EXPECT_GT(count, 100);
    EXPECT_LT(count, 300);
}

TEST(Windy, MultipliesTwoNoises) {
    TextureBuilder b;
    const int windy = b.Add(kFloat, "windy", {});
    const int colored = b.Add(kSpectrum, "windy", {});
    const TextureTable table = b.Build();
    const Vec3f p(3.3f, -1.7f, 8.2f);
    const float expected = std::abs(FractionalBrownianMotion(0.1f * p, 0, 0.5f, 3)) *
                           FractionalBrownianMotion(p, 0, 0.5f, 6);
    EXPECT_FLOAT_EQ(table.Evaluate(b.Float(table, windy), AtPoint(p)), expected);
    EXPECT_FLOAT_EQ(table.Evaluate(b.Spectrum(table, colored), AtPoint(p)).y(), expected);
    EXPECT_EQ(table.Needs(b.Float(table, windy)), kNeedsFootprint);
}

TEST(Wrinkled, SumsMagnitudes) {
    TextureBuilder b;
    const int wrinkled = b.Add(kFloat, "wrinkled", {Int("octaves", 3), Float("roughness", 0.7f)});
    const TextureTable table = b.Build();
    const Vec3f p(3.3f, -1.7f, 8.2f);
    float expected = 0, frequency = 1, amplitude = 1;
    for (int i = 0; i < 3; ++i) {
        expected += amplitude * std::abs(Noise(frequency * p));
        frequency *= 1.99f;
        amplitude *= 0.7f;
    }
    expected += 0.2f * amplitude;  // pbrt-v3's, for an octave that is not there
    EXPECT_NEAR(table.Evaluate(b.Float(table, wrinkled), AtPoint(p)), expected, 1e-5f);
}

// Octaves that samples do not resolve give way to their mean.
TEST(Turbulence, FadesToItsMean) {
    const Vec3f p(0.3f, 0.6f, 0.9f);
    EXPECT_NEAR(Turbulence(p, 1e6f, 0.5f, 8), 0.2f + 0.2f * (2 - std::pow(0.5f, 7.f)), 1e-5f);
    EXPECT_NEAR(Turbulence(p, Sqr(0x1p-12f), 0.5f, 8), Turbulence(p, 0, 0.5f, 8), 1e-5f);
}

// The expected values were computed by pbrt-v3's own functions, compiled on their own.
struct NoiseCase {
    Vec3f p;
    float noise, fbm, rough;  // noise; 8 octaves of roughness 0.5; 3 of 0.7
};
const NoiseCase kNoiseCases[] = {
    {{0.300000012f, 0.600000024f, 0.899999976f}, -0.141769052f, 0.026837213f, 0.00916262902f},
    {{-1.70000005f, 2.20000005f, -3.4000001f}, 0.221766427f, 0.177036956f, 0.14951019f},
    {{10.1000004f, -20.2000008f, 30.2999992f}, 0.340536952f, 0.177636191f, 0.0987504572f},
    {{255.5f, 256.25f, -0.125f}, -0.139493883f, -0.325777709f, -0.356542796f},
    {{1000.25f, -1.5f, 77.75f}, -0.206278801f, -0.0432690494f, -0.0333760679f},
    {{0.00999999978f, 0.0199999996f, 0.0299999993f}, 0.0401485153f, 0.17639631f, 0.176211208f},
    {{-0.5f, -0.5f, -0.5f}, -0.375f, -0.406777322f, -0.382000834f},
    {{127.900002f, 64.0999985f, -300.700012f}, -0.300209522f, -0.5622527f, -0.723098576f},
};

struct MarbleCase {
    Vec3f p;
    Rgb plain, other;  // defaults; scale 4, variation 1.5, roughness 0.4, 5 octaves
};
const MarbleCase kMarbleCases[] = {
    {{0.300000012f, 0.600000024f, 0.899999976f},
     {15.7925291f, 15.0282898f, 16.1141033f},
     {8.93919086f, 8.49662971f, 8.99497318f}},
    {{-1.70000005f, 2.20000005f, -3.4000001f},
     {26.3785629f, 25.1340675f, 27.1855145f},
     {8.00689602f, 7.60930681f, 8.03198338f}},
    {{10.1000004f, -20.2000008f, 30.2999992f},
     {0.869888127f, 0.869888127f, 0.899860263f},
     {29.3848343f, 28.0060959f, 30.3392601f}},
    {{255.5f, 256.25f, -0.125f},
     {0.86999619f, 0.86999619f, 0.899995387f},
     {32.9284744f, 31.3923798f, 34.0606956f}},
    {{1000.25f, -1.5f, 77.75f},
     {0.870000005f, 0.870000005f, 0.900000036f},
     {6.91330528f, 6.56904745f, 6.90498161f}},
    {{0.00999999978f, 0.0199999996f, 0.0299999993f},
     {3.14321566f, 2.990839f, 3.055825f},
     {14.8672848f, 14.1457977f, 15.1499262f}},
    {{-0.5f, -0.5f, -0.5f},
     {0.842346787f, 0.841689587f, 0.862476289f},
     {0.86357832f, 0.86357832f, 0.891973019f}},
    {{127.900002f, 64.0999985f, -300.700012f},
     {34.4349785f, 32.8322372f, 35.6439209f},
     {0.869972348f, 0.869972348f, 0.899965525f}},
};

TEST(Noise, EqualsPbrt) {
    for (const NoiseCase& c : kNoiseCases) {
        EXPECT_NEAR(Noise(c.p), c.noise, 2e-6f) << c.p.transpose();
        EXPECT_NEAR(FractionalBrownianMotion(c.p, 0, 0.5f, 8), c.fbm, 2e-5f) << c.p.transpose();
        EXPECT_NEAR(FractionalBrownianMotion(c.p, 0, 0.7f, 3), c.rough, 2e-5f) << c.p.transpose();
    }
}

TEST(Noise, VanishesOnTheLatticeAndHasPeriod256) {
    for (int i = -3; i < 4; ++i) EXPECT_EQ(Noise(Vec3f(float(i), float(7 * i), float(-i))), 0);
    EXPECT_EQ(Noise({0.25f, 0.5f, 0.75f}), Noise({256.25f, -255.5f, 512.75f}));
}

TEST(Noise, IsContinuousAcrossCells) {
    for (int axis = 0; axis < 3; ++axis) {
        Vec3f p(0.3f, 0.7f, 0.2f), q = p;
        p[axis] = 2 - 1e-5f;
        q[axis] = 2 + 1e-5f;
        EXPECT_NEAR(Noise(p), Noise(q), 1e-4f);
    }
}

TEST(Fbm, AppliesTheTransformationAsPbrt) {
    TextureBuilder builder;
    Mat4d scale = Mat4d::Identity();
    scale.topLeftCorner<3, 3>() *= 2;
    const int gray = builder.Add(true, "fbm", {}, scale);
    const int rough =
        builder.Add(false, "fbm", {Int("octaves", 3), Float("roughness", 0.7f)}, scale);
    const TextureTable table = builder.Build();
    for (const NoiseCase& c : kNoiseCases) {
        const TextureContext at = AtPoint(c.p / 2);
        const Rgb v = table.Evaluate(builder.Spectrum(table, gray), at);
        EXPECT_NEAR(v.x(), c.fbm, 2e-5f);
        EXPECT_EQ(v.x(), v.z());
        EXPECT_NEAR(table.Evaluate(builder.Float(table, rough), at), c.rough, 2e-5f);
    }
    EXPECT_FALSE(table.Needs(builder.Float(table, rough)) & kNeedsUv);
}

TEST(Marble, EqualsPbrt) {
    TextureBuilder builder;
    const int plain = builder.Add(true, "marble", {});
    const int other = builder.Add(
        true, "marble",
        {Float("scale", 4), Float("variation", 1.5f), Float("roughness", 0.4f), Int("octaves", 5)});
    const TextureTable table = builder.Build();
    for (const MarbleCase& c : kMarbleCases) {
        const Rgb a = table.Evaluate(builder.Spectrum(table, plain), AtPoint(c.p));
        const Rgb b = table.Evaluate(builder.Spectrum(table, other), AtPoint(c.p));
        for (int i = 0; i < 3; ++i) {
            // The extrapolated cubic magnifies the rounding of large coordinates.
            EXPECT_NEAR(a[i], c.plain[i], 2e-4f * std::max(1.f, c.plain[i])) << c.p.transpose();
            EXPECT_NEAR(b[i], c.other[i], 2e-3f * std::max(1.f, c.other[i])) << c.p.transpose();
        }
    }
}

}  // namespace

}  // namespace lull
