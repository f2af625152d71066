#include <gtest/gtest.h>

#include "renderer/scene/textures/mapping.h"
#include "renderer/scene/textures/texture.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/scene/textures/texture_builder.h"

namespace lull::texture_test {
namespace {

constexpr bool kFloat = false, kSpectrum = true;

Parameter Filename(const std::string& name) { return String("filename", name); }

TEST(TextureTable, ReadsParameters) {
    TextureBuilder builder;
    const TextureTable table = builder.Build();
    Entity entity;
    entity.parameters.Add(Float("sigma", 0.25f));
    entity.parameters.Add(Floats("excess", {1, 2}));
    entity.parameters.Add(Color("Kd", {1, 2, 3}));
    EXPECT_EQ(table.GetFloat(entity, "sigma", 9).constant, 0.25f);
    EXPECT_EQ(table.GetFloat(entity, "excess", 9).constant, 1);
    EXPECT_EQ(table.GetFloat(entity, "absent", 9).constant, 9);
    EXPECT_EQ(table.GetFloat(entity, "Kd", 9).constant, 9);  // of another type
    EXPECT_TRUE((table.GetSpectrum(entity, "Kd", Rgb::Zero()).constant == Rgb(1, 2, 3)).all());
    EXPECT_TRUE((table.GetSpectrum(entity, "sigma", Rgb(4, 5, 6)).constant == Rgb(4, 5, 6)).all());
    EXPECT_FALSE(table.GetFloatOrNone(entity, "absent").has_value());
    EXPECT_TRUE(table.GetFloatOrNone(entity, "sigma").has_value());
}

TEST(TextureTable, RefusesTexturesThatAreNotThere) {
    TextureBuilder builder;
    const int spectrum = builder.Add(kSpectrum, "constant", {});
    const TextureTable table = builder.Build();
    EXPECT_EQ(ErrorOf([&] { builder.Float(table, -1); }),
              "scene.pbrt:7: parameter \"x\": there is no float texture \"t-1\"; with "
              "--substitute the parameter is left out");
    EXPECT_HAS(ErrorOf([&] { builder.Float(table, spectrum); }), "of the other type");
    EXPECT_EQ(ErrorOf([&] { builder.Spectrum(table, spectrum); }), "");
}

TEST(TextureTable, RefusesReferencesToItself) {
    TextureBuilder builder;
    const int texture = builder.Add(kFloat, "scale", {});
    builder.description.textures[0].parameters.Add(builder.Ref("tex1", texture));
    EXPECT_HAS(ErrorOf([&] { builder.Build(); }), "there is no float texture");
}

TEST(TextureTable, RefusesKindsByNameFileAndLine) {
    for (const char* kind : {"ptex", "nonsense"}) {
        for (const bool isSpectrum : {kFloat, kSpectrum}) {
            TextureBuilder strict;
            strict.Add(isSpectrum, kind, {});
            const std::string error = ErrorOf([&] { strict.Build(); });
            EXPECT_HAS(error, "scene.pbrt:10: ");
            EXPECT_HAS(error, kind);
            EXPECT_HAS(error, "with --substitute 1 stands in");

            TextureBuilder builder(true);
            const int texture = builder.Add(isSpectrum, kind, {Float("whatever", 1)});
            const TextureTable table = builder.Build();
            EXPECT_EQ(builder.warnings.Total(), 1);
            if (isSpectrum)
                EXPECT_TRUE((builder.Spectrum(table, texture).constant == 1).all());
            else
                EXPECT_EQ(builder.Float(table, texture).constant, 1);
        }
    }
    // pbrt-v3 has no float marble either.
    TextureBuilder builder;
    builder.Add(kFloat, "marble", {});
    EXPECT_HAS(ErrorOf([&] { builder.Build(); }), "float texture \"t0\"");
}

TEST(TextureTable, WarnsOfUnusedParameters) {
    TextureBuilder builder;
    builder.Add(kFloat, "fbm", {Int("octaves", 3), Float("octave", 1)});
    builder.Build();
    EXPECT_EQ(builder.warnings.Total(), 1);
}

TEST(TextureTable, CanBeMovedAndBeEmpty) {
    TextureBuilder builder;
    const int fbm = builder.Add(kFloat, "fbm", {});
    TextureTable table = builder.Build();
    const TextureContext c = AtPoint({0.3f, 0.6f, 0.9f});
    const float before = table.Evaluate(builder.Float(table, fbm), c);
    TextureTable other;
    EXPECT_EQ(other.Bytes(), 0u);
    other = std::move(table);
    EXPECT_EQ(other.Evaluate(builder.Float(other, fbm), c), before);
}

TEST(Constant, HasPbrtDefaults) {
    TextureBuilder builder;
    const int one = builder.Add(kFloat, "constant", {});
    const int half = builder.Add(kFloat, "constant", {Float("value", 0.5f)});
    const int rgb = builder.Add(kSpectrum, "constant", {Color("value", {1, 2, 3})});
    const TextureTable table = builder.Build();
    EXPECT_EQ(builder.Float(table, one).constant, 1);
    EXPECT_EQ(builder.Float(table, half).constant, 0.5f);
    EXPECT_TRUE((builder.Spectrum(table, rgb).constant == Rgb(1, 2, 3)).all());
}

TEST(Scale, Multiplies) {
    TextureBuilder builder;
    const int board = builder.Add(kSpectrum, "checkerboard",
                                  {Color("tex1", {1, 2, 3}), Color("tex2", {4, 5, 6})});
    const int scale =
        builder.Add(kSpectrum, "scale", {builder.Ref("tex1", board), Color("tex2", {2, 3, 4})});
    const TextureTable table = builder.Build();
    const SpectrumTexture texture = builder.Spectrum(table, scale);
    EXPECT_FALSE(texture.IsConstant());
    EXPECT_TRUE((table.Evaluate(texture, At(0.5f, 0.5f)) == Rgb(2, 6, 12)).all());
    EXPECT_TRUE((table.Evaluate(texture, At(1.5f, 0.5f)) == Rgb(8, 15, 24)).all());
    EXPECT_TRUE(table.Needs(texture) & kNeedsUv);
}

TEST(Scale, FoldsConstants) {
    TextureBuilder builder;
    const int fbm = builder.Add(kFloat, "fbm", {});
    const int product = builder.Add(kFloat, "scale", {Float("tex1", 3), Float("tex2", 0.5f)});
    const int chained =
        builder.Add(kFloat, "scale", {builder.Ref("tex1", product), Float("tex2", 2)});
    const int same = builder.Add(kFloat, "scale", {builder.Ref("tex2", fbm)});
    const int zero = builder.Add(kFloat, "scale", {builder.Ref("tex1", fbm), Float("tex2", 0)});
    const TextureTable table = builder.Build();
    EXPECT_EQ(builder.Float(table, product).constant, 1.5f);
    EXPECT_TRUE(builder.Float(table, chained).IsConstant());
    EXPECT_EQ(builder.Float(table, chained).constant, 3);
    EXPECT_EQ(builder.Float(table, same).index, builder.Float(table, fbm).index);
    EXPECT_TRUE(builder.Float(table, zero).IsConstant());
    EXPECT_EQ(builder.Float(table, zero).constant, 0);
}

TEST(Mix, Interpolates) {
    TextureBuilder builder;
    const int amount =
        builder.Add(kFloat, "checkerboard", {Float("tex1", 0.25f), Float("tex2", 2)});
    const int mix =
        builder.Add(kSpectrum, "mix",
                    {Color("tex1", {0, 4, 8}), Grey("tex2", 4), builder.Ref("amount", amount)});
    const TextureTable table = builder.Build();
    const SpectrumTexture texture = builder.Spectrum(table, mix);
    EXPECT_TRUE((table.Evaluate(texture, At(0.5f, 0.5f)) == Rgb(1, 4, 7)).all());
    EXPECT_TRUE((table.Evaluate(texture, At(1.5f, 0.5f)) == Rgb(8, 4, 0)).all());
    EXPECT_TRUE(table.Needs(texture) & kNeedsUv);
}

TEST(Mix, HasPbrtDefaultsAndFoldsConstants) {
    TextureBuilder builder;
    const int fbm = builder.Add(kFloat, "fbm", {});
    const int plain = builder.Add(kFloat, "mix", {});
    const int first = builder.Add(kFloat, "mix", {builder.Ref("tex1", fbm), Float("amount", 0)});
    const int second = builder.Add(kFloat, "mix", {builder.Ref("tex1", fbm), Float("amount", 1)});
    const int equal = builder.Add(kFloat, "mix",
                                  {Float("tex1", 3), Float("tex2", 3), builder.Ref("amount", fbm)});
    const TextureTable table = builder.Build();
    EXPECT_EQ(builder.Float(table, plain).constant, 0.5f);
    EXPECT_EQ(builder.Float(table, first).index, builder.Float(table, fbm).index);
    EXPECT_TRUE(builder.Float(table, second).IsConstant());
    EXPECT_EQ(builder.Float(table, second).constant, 1);
    EXPECT_EQ(builder.Float(table, equal).constant, 3);
}

TEST(Checkerboard, AlternatesInTwoDimensions) {
    TextureBuilder builder;
    const int board = builder.Add(
        kFloat, "checkerboard",
        {Float("uscale", 2), Float("vscale", 4), Float("udelta", 1), String("aamode", "none")});
    const TextureTable table = builder.Build();
    const FloatTexture texture = builder.Float(table, board);
    // (2 u + 1, 4 v): tex1 (1) where the sum of the floors is even, else tex2 (0).
    EXPECT_EQ(table.Evaluate(texture, At(0.1f, 0.1f)), 0);
    EXPECT_EQ(table.Evaluate(texture, At(0.6f, 0.1f)), 1);
    EXPECT_EQ(table.Evaluate(texture, At(0.6f, 0.3f)), 0);
    EXPECT_EQ(table.Evaluate(texture, At(-0.1f, 0.1f)), 1);
    EXPECT_EQ(table.Evaluate(texture, At(-0.6f, 0.1f)), 0);
    EXPECT_EQ(table.Evaluate(texture, At(-0.1f, -0.1f)), 0);
    EXPECT_EQ(builder.warnings.Total(), 0);
}

TEST(Checkerboard, AlternatesInThreeDimensions) {
    TextureBuilder builder;
    Mat4d scale = Mat4d::Identity();
    scale.topLeftCorner<3, 3>() *= 10;
    const int board = builder.Add(kFloat, "checkerboard", {Int("dimension", 3)}, scale);
    const TextureTable table = builder.Build();
    const FloatTexture texture = builder.Float(table, board);
    EXPECT_FALSE(table.Needs(texture) & kNeedsUv);
    // As in pbrt-v3 the transformation is applied itself: cubes of 0.1.
    EXPECT_EQ(table.Evaluate(texture, AtPoint({0.05f, 0.05f, 0.05f})), 1);
    EXPECT_EQ(table.Evaluate(texture, AtPoint({0.15f, 0.05f, 0.05f})), 0);
    EXPECT_EQ(table.Evaluate(texture, AtPoint({0.15f, 0.15f, 0.05f})), 1);
    EXPECT_EQ(table.Evaluate(texture, AtPoint({0.15f, 0.15f, -0.05f})), 0);
}

TEST(Checkerboard, RefusesOtherDimensions) {
    TextureBuilder strict, builder(true);
    strict.Add(kFloat, "checkerboard", {Int("dimension", 4)});
    EXPECT_HAS(ErrorOf([&] { strict.Build(); }), "scene.pbrt:10: 4-dimensional");
    const int board = builder.Add(kFloat, "checkerboard", {Int("dimension", 4)});
    EXPECT_EQ(builder.Float(builder.Build(), board).constant, 1);
}

TEST(Checkerboard, FoldsEqualColors) {
    TextureBuilder builder;
    const int board = builder.Add(kSpectrum, "checkerboard",
                                  {Color("tex1", {1, 2, 3}), Color("tex2", {1, 2, 3})});
    EXPECT_TRUE(builder.Spectrum(builder.Build(), board).IsConstant());
}

TEST(Texture, SurvivesAnyCoordinates) {
    const TemporaryDirectory directory;
    const std::string tga = directory.Write(
        "a.tga", std::string("\0\0\2\0\0\0\0\0\0\0\0\0\2\0\1\0\x18\0", 18) + "\1\2\3\4\5\6");
    TextureBuilder builder;
    std::vector<int> textures;
    for (const char* mapping : {"uv", "spherical", "cylindrical", "planar"}) {
        const Parameter map = String("mapping", mapping);
        for (const char* wrap : {"repeat", "black", "clamp"})
            textures.push_back(
                builder.Add(kSpectrum, "imagemap", {Filename(tga), String("wrap", wrap), map}));
        textures.push_back(builder.Add(kSpectrum, "checkerboard", {map}));
    }
    textures.push_back(builder.Add(kSpectrum, "checkerboard", {Int("dimension", 3)}));
    textures.push_back(builder.Add(kSpectrum, "fbm", {Int("octaves", 1000000000)}));
    textures.push_back(builder.Add(kSpectrum, "fbm", {Int("octaves", -5)}));
    textures.push_back(builder.Add(kSpectrum, "marble", {}));
    const TextureTable table = builder.Build();

    const float nan = std::numeric_limits<float>::quiet_NaN();
    constexpr float kMost = 0x1.fffffep127f, kLeast = 0x1p-149f, kBelow1 = kOneMinusEpsilon;
    const float values[] = {0,        -0.f,      1,          -1,     kLeast,  -kLeast,
                            16777216, 1e9f,      -3e9f,      1e19f,  1e30f,   -1e30f,
                            nan,      kInfinity, -kInfinity, -1e-9f, kBelow1, kMost};
    for (const int texture : textures) {
        const SpectrumTexture t = builder.Spectrum(table, texture);
        for (const float a : values)
            for (const float b : values) {
                const Rgb v = table.Evaluate(t, {{a, b, a}, {a, b}});
                EXPECT_TRUE(IsFinite(v)) << texture << " at " << a << ", " << b;
            }
    }
}

}  // namespace
}  // namespace lull::texture_test

namespace lull {
namespace {

// Makes the mapping that a texture with these parameters has.
Mapping2D Make(std::vector<Parameter> parameters, const Mat4d& worldFromTexture = Mat4d::Identity(),
               bool substitutes = false) {
    TextureBuilder builder(substitutes);
    builder.Add(false, "checkerboard", std::move(parameters), worldFromTexture);
    const TextureTable table;
    TextureImages images;
    const Mapping2D mapping = MakeMapping2D(
        {builder.description.textures[0], builder.description, table, images, builder.warnings});
    builder.warnings.ThrowErrors();
    return mapping;
}

void ExpectMap(const Mapping2D& mapping, const Vec3f& p, float s, float t) {
    const Vec2f st = Map(mapping, AtPoint(p));
    EXPECT_NEAR(st.x(), s, 1e-6f) << p.transpose();
    EXPECT_NEAR(st.y(), t, 1e-6f) << p.transpose();
}

TEST(UvMapping, ScalesAndShifts) {
    const Mapping2D plain = Make({});
    EXPECT_TRUE(Needs(plain) & kNeedsUv);
    EXPECT_EQ(Map(plain, At(0.25f, 0.5f)), Vec2f(0.25f, 0.5f));
    const Mapping2D mapping =
        Make({Float("uscale", 2), Float("vscale", -3), Float("udelta", 10), Float("vdelta", 20)});
    EXPECT_EQ(Map(mapping, At(0.25f, 0.5f)), Vec2f(10.5f, 18.5f));
}

TEST(SphericalMapping, GivesAnglesOverPi) {
    Mat4d shift = Mat4d::Identity();
    shift(0, 3) = 100;  // the inverse is applied, unlike for solid textures
    const Mapping2D mapping = Make({String("mapping", "spherical")}, shift);
    EXPECT_FALSE(Needs(mapping) & kNeedsUv);
    ExpectMap(mapping, {100, 0, 5}, 0, 0);
    ExpectMap(mapping, {103, 0, 0}, 0.5f, 0);
    ExpectMap(mapping, {100, 2, 0}, 0.5f, 0.25f);
    ExpectMap(mapping, {99, 0, 0}, 0.5f, 0.5f);
    ExpectMap(mapping, {100, -1, 0}, 0.5f, 0.75f);
    ExpectMap(mapping, {101, 1, -std::sqrt(2.f)}, 0.75f, 0.125f);
}

TEST(CylindricalMapping, GivesAngleAndHeightOfTheUnitDirection) {
    const Mapping2D mapping = Make({String("mapping", "cylindrical")});
    EXPECT_FALSE(Needs(mapping) & kNeedsUv);
    ExpectMap(mapping, {2, 0, 0}, 0.5f, 0);
    ExpectMap(mapping, {0, 2, 0}, 0.75f, 0);
    ExpectMap(mapping, {0, -3, 4}, 0.25f, 0.8f);
    ExpectMap(mapping, {-3, 0, -4}, 1, -0.8f);
}

TEST(PlanarMapping, ProjectsWorldPoints) {
    Mat4d shift = Mat4d::Identity();
    shift(0, 3) = 100;  // has no effect
    const Parameter planar = String("mapping", "planar");
    ExpectMap(Make({planar}, shift), {1, 2, 3}, 1, 2);
    ExpectMap(Make({planar, VectorParameter("v1", 0, 0, 2), VectorParameter("v2", 1, 1, 0),
                    Float("udelta", 0.5f), Float("vdelta", -1)}),
              {1, 2, 3}, 6.5f, 2);
}

TEST(Mapping, RefusesUnknownNames) {
    EXPECT_HAS(ErrorOf([] { Make({String("mapping", "toroidal")}); }),
               "scene.pbrt:10: texture mapping \"toroidal\"");
    const Mapping2D mapping = Make({String("mapping", "toroidal")}, Mat4d::Identity(), true);
    EXPECT_EQ(Map(mapping, At(0.25f, 0.5f)), Vec2f(0.25f, 0.5f));
}

}  // namespace
}  // namespace lull
