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
    const int colored = b.Add(kSpectrum, "bilerp",
                              {RgbParameter("v00", 1, 0, 0), RgbParameter("v01", 0, 1, 0),
                               RgbParameter("v10", 0, 0, 1), RgbParameter("v11", 2, 2, 2),
                               FloatParameter("uscale", {2}), FloatParameter("vdelta", {0.5f})});
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
    const int uv = b.Add(kSpectrum, "uv", {FloatParameter("uscale", {3})});
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
    const int dots =
        b.Add(kFloat, "dots", {FloatParameter("inside", {2}), FloatParameter("outside", {5})});
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
    const int wrinkled = b.Add(kFloat, "wrinkled",
                               {IntParameter("octaves", 3), FloatParameter("roughness", {0.7f})});
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

}  // namespace
}  // namespace lull
