#include <gtest/gtest.h>

#include <random>

#include "renderer/image/image_io.h"
#include "renderer/scene/textures/mip_pyramid.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/scene/textures/texture_builder.h"

namespace lull {
namespace {

constexpr Wrap kWraps[] = {Wrap::Repeat, Wrap::Black, Wrap::Clamp, Wrap::Mirror};

// Returns a grey image of one value, or of value(x, y).
template <typename Value>
MipPyramid MakeGrey(int width, int height, Wrap wrap, const Value& value) {
    std::vector<float> texels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) texels.push_back(value(x, y));
    return {width, height, 1, std::move(texels), wrap, wrap};
}

// Finds the weight of a texel of an image without any as pbrt 3rd ed., section 10.4.5 writes it
// down, in double precision.
double EwaByTheBook(const std::vector<float>& texels, int side, const Vec2f& st, Vec2f d0,
                    Vec2f d1) {
    const Eigen::Vector2d c = (st * float(side) - Vec2f(0.5f, 0.5f)).cast<double>();
    const Eigen::Vector2d e0 = d0.cast<double>() * side, e1 = d1.cast<double>() * side;
    double A = e0.y() * e0.y() + e1.y() * e1.y() + 1;
    double B = -2 * (e0.x() * e0.y() + e1.x() * e1.y());
    double C = e0.x() * e0.x() + e1.x() * e1.x() + 1;
    const double F = A * C - B * B / 4;
    double sum = 0, weights = 0;
    for (int y = -4 * side; y < 4 * side; ++y)
        for (int x = -4 * side; x < 4 * side; ++x) {
            const double s = x - c.x(), t = y - c.y();
            const double r2 = (A * s * s + B * s * t + C * t * t) / F;
            if (r2 >= 1) continue;
            const double w = std::exp(-2 * std::floor(r2 * 128) / 127) - std::exp(-2.);
            weights += w;
            sum += w * texels[size_t((y + 8 * side) % side * side + (x + 8 * side) % side)];
        }
    return sum / weights;
}

TEST(MipPyramid, LeavesAConstantAsItIs) {
    std::mt19937 random(1);
    std::uniform_real_distribution<float> anywhere(-3, 4), exponent(-12, 1);
    for (const Wrap wrap : {Wrap::Repeat, Wrap::Clamp, Wrap::Mirror})
        for (const auto& [width, height] : {std::pair(8, 8), {1, 1}, {5, 3}, {16, 2}, {1, 7}}) {
            const MipPyramid pyramid =
                MakeGrey(width, height, wrap, [](int, int) { return 0.625f; });
            const MipPyramid color(width, height, 3,
                                   std::vector<float>(size_t(width * height) * 3, 0.625f), wrap,
                                   wrap);
            for (int i = 0; i < 300; ++i) {
                const Vec2f st(anywhere(random), anywhere(random));
                const float size = std::exp2(exponent(random));
                const Vec2f d0 = size * Vec2f(anywhere(random), anywhere(random));
                const Vec2f d1 = size * Vec2f(anywhere(random), anywhere(random));
                EXPECT_NEAR(pyramid.Trilinear<float>(st, size), 0.625f, 1e-5f);
                EXPECT_NEAR(pyramid.Ewa<float>(st, d0, d1, 8), 0.625f, 1e-5f);
                EXPECT_LT((color.Ewa<Rgb>(st, d0, d1, 8) - 0.625f).abs().maxCoeff(), 1e-5f);
            }
        }
}

TEST(MipPyramid, HasHalfTheSidesAtEachLevel) {
    EXPECT_EQ(MakeGrey(8, 8, Wrap::Repeat, [](int, int) { return 1.f; }).LevelCount(), 4);
    const MipPyramid flat = MakeGrey(16, 2, Wrap::Repeat, [](int, int) { return 1.f; });
    EXPECT_EQ(flat.LevelCount(), 5);
    EXPECT_EQ(flat.Bytes(), (32 + 8 + 4 + 2 + 1) * sizeof(float));
    // Enlarged to 8 by 4.
    EXPECT_EQ(MakeGrey(5, 3, Wrap::Clamp, [](int, int) { return 1.f; }).Bytes(),
              (32 + 8 + 2 + 1) * sizeof(float));
    EXPECT_EQ(MipPyramid(1, 1, 3, {1, 2, 3}, Wrap::Black, Wrap::Black).Bytes(), 3 * sizeof(float));
}

TEST(MipPyramid, AveragesFourTexels) {
    // A ramp of 8 texels across: level 1 has the means of pairs, and so on.
    const MipPyramid ramp = MakeGrey(8, 8, Wrap::Clamp, [](int x, int) { return float(x); });
    for (int x = 0; x < 4; ++x)
        EXPECT_FLOAT_EQ(ramp.Bilinear<float>(1, {(float(x) + 0.5f) / 4, 0.3f}),
                        2 * float(x) + 0.5f);
    EXPECT_FLOAT_EQ(ramp.Bilinear<float>(2, {0.25f, 0.3f}), 1.5f);
    EXPECT_FLOAT_EQ(ramp.Bilinear<float>(3, {0.1f, 0.9f}), 3.5f);
    // Beyond a black image is black: of 4 by 1 texels, the second row of each four is not there.
    const MipPyramid black = MakeGrey(4, 1, Wrap::Black, [](int, int) { return 1.f; });
    EXPECT_EQ(black.Bilinear<float>(0, {0.5f, 0.5f}), 1);
    EXPECT_EQ(black.Bilinear<float>(1, {0.5f, 0.5f}), 0.5f);
}

TEST(MipPyramid, KeepsRampsInAllFilters) {
    // A linear ramp is unchanged under any symmetric weights, away from the borders.
    const MipPyramid ramp = MakeGrey(256, 256, Wrap::Clamp, [](int x, int y) {
        return (float(x) + 0.5f) / 256 + 2 * (float(y) + 0.5f) / 256;
    });
    for (const Vec2f& st : {Vec2f(0.5f, 0.5f), Vec2f(0.43f, 0.61f), Vec2f(0.6f, 0.37f)}) {
        const float expected = st.x() + 2 * st.y();
        for (const float width : {1e-4f, 0.004f, 0.01f, 0.05f, 0.1f}) {
            EXPECT_NEAR(ramp.Trilinear<float>(st, width), expected, 1e-5f) << width;
            // The weights come from a table, so that those of both sides differ by its steps.
            EXPECT_NEAR(ramp.Ewa<float>(st, {width, width / 3}, {-width / 8, width / 4}, 8),
                        expected, 0.004f)
                << width;
        }
    }
}

TEST(MipPyramid, InterpolatesBetweenLevels) {
    // From level 0 at a width of a texel to level 1 at that of two.
    const MipPyramid pyramid =
        MakeGrey(4, 4, Wrap::Repeat, [](int x, int y) { return float((5 * x + 3 * y * y) % 7); });
    const Vec2f st(0.3f, 0.8f);
    const float fine = pyramid.Bilinear<float>(0, st), next = pyramid.Bilinear<float>(1, st);
    EXPECT_NE(fine, next);
    EXPECT_EQ(pyramid.Trilinear<float>(st, 0), fine);
    EXPECT_EQ(pyramid.Trilinear<float>(st, 0.2f), fine);
    EXPECT_NEAR(pyramid.Trilinear<float>(st, 0.25f * std::sqrt(2.f)), (fine + next) / 2, 1e-5f);
    EXPECT_NEAR(pyramid.Trilinear<float>(st, 0.5f), next, 1e-5f);
    EXPECT_EQ(pyramid.Trilinear<float>(st, 1), pyramid.Bilinear<float>(2, st));
    EXPECT_EQ(pyramid.Trilinear<float>(st, 1e30f), pyramid.Bilinear<float>(2, st));
}

TEST(MipPyramid, WeighsTexelsAsTheBookSays) {
    constexpr int kSide = 16;
    std::mt19937 random(2);
    std::uniform_real_distribution<float> unit(0, 1), around(-1, 1);
    std::vector<float> texels;
    for (int i = 0; i < kSide * kSide; ++i) texels.push_back(unit(random));
    const MipPyramid pyramid(kSide, kSide, 1, texels, Wrap::Repeat, Wrap::Repeat);
    for (int i = 0; i < 200; ++i) {
        // The shorter axis is at most a texel long, so that the finest level alone counts.
        const Vec2f st(unit(random), unit(random));
        const float angle = 7 * unit(random);
        const Vec2f d0 = 4 * unit(random) / kSide * Vec2f(std::cos(angle), std::sin(angle));
        const Vec2f d1 = 0.6f / kSide * Vec2f(around(random), around(random));
        EXPECT_NEAR(pyramid.Ewa<float>(st, d0, d1, 1000), EwaByTheBook(texels, kSide, st, d0, d1),
                    // A texel on the border between two entries may get either.
                    2e-3);
        EXPECT_EQ(pyramid.Ewa<float>(st, d0, d1, 1000), pyramid.Ewa<float>(st, d1, d0, 1000));
    }
}

TEST(MipPyramid, WidensThinEllipses) {
    // Stripes along s: a long ellipse along them must not mix them, unless it is made as wide as
    // an eighth of its length.
    const MipPyramid stripes =
        MakeGrey(64, 64, Wrap::Repeat, [](int, int y) { return float(y / 4 % 2); });
    const Vec2f inside(0.3f, 6 / 64.f);
    EXPECT_EQ(stripes.Ewa<float>(inside, {0.5f, 0}, {0, 0.001f}, 1000), 1);
    EXPECT_LT(stripes.Ewa<float>(inside, {0.5f, 0}, {0, 0.001f}, 4), 0.7f);
    // Along one axis alone there is no area, and the finest level as it is.
    EXPECT_EQ(stripes.Ewa<float>(inside, {0.5f, 0}, {0, 0}, 8), stripes.Bilinear<float>(0, inside));
}

TEST(MipPyramid, EnlargesByLanczos) {
    // 3 texels become 4. The first lies at 0.375 of the old ones, which reach from -1.5 to 2.5;
    // the weights are those of sinc(x) sinc(x / 2), normalised.
    const MipPyramid pyramid = MakeGrey(3, 1, Wrap::Clamp, [](int x, int) {
        return std::array{1.f, 0.25f, 0.5f}[size_t(x)];
    });
    const auto sinc = [](double x) { return x == 0 ? 1 : std::sin(kPi * x) / (kPi * x); };
    double sum = 0, weights = 0;
    for (int i = -2; i < 2; ++i) {
        const double x = i + 0.5 - 0.375, w = sinc(x) * sinc(x / 2);
        weights += w;
        sum += w * (i < 1 ? 1 : 0.25);
    }
    EXPECT_NEAR(pyramid.Bilinear<float>(0, {0.125f, 0.5f}), sum / weights, 1e-5);
    // Steep edges swing below 0, which colours cannot.
    const MipPyramid edge =
        MakeGrey(20, 1, Wrap::Repeat, [](int x, int) { return x < 10 ? 0.f : 1.f; });
    float least = 1, most = 0;
    for (int x = 0; x < 32; ++x) {
        const float v = edge.Bilinear<float>(0, {(float(x) + 0.5f) / 32, 0.5f});
        least = std::min(least, v);
        most = std::max(most, v);
    }
    EXPECT_EQ(least, 0);
    EXPECT_GT(most, 1.02f);
}

TEST(MipPyramid, WithstandsAnyPointAndFootprint) {
    const float odd[] = {0,     1e-38f,    1e-20f,     0.3f,         1, 1e5f, 1e20f,
                         3e38f, kInfinity, -kInfinity, std::nanf("")};
    for (const Wrap wrap : kWraps) {
        const MipPyramid pyramid = MakeGrey(8, 4, wrap, [](int x, int y) { return float(x * y); });
        for (const float a : odd)
            for (const float b : odd)
                for (const float c : odd)
                    for (const float d : odd) {
                        const float e = pyramid.Ewa<float>({a, b}, {c, d}, {b, a}, 16);
                        EXPECT_TRUE(e >= 0 && e <= 21) << a << " " << b << " " << c << " " << d;
                        const float t = pyramid.Trilinear<float>({a, b}, c);
                        EXPECT_TRUE(t >= 0 && t <= 21) << a << " " << b << " " << c;
                    }
    }
}

TEST(MipPyramid, RefusesWhatMemoryCannotHold) {
    EXPECT_TRUE(
        Contains(ErrorOf([] { MipPyramid(1 << 24, 1 << 20, 3, {}, Wrap::Repeat, Wrap::Repeat); }),
                 "leave out --filtering pbrt-v3"));
}

// A picture of 4x4 texels, black and white alternately, as a texture filtered as asked for.
struct Checks {
    TemporaryDirectory directory;
    TextureBuilder builder;
    int texture;

    explicit Checks(std::vector<Parameter> parameters) {
        std::vector<Rgb> texels;
        for (int i = 0; i < 16; ++i) texels.push_back(Rgb::Constant(float((i % 4 + i / 4) % 2)));
        const std::string file = directory.File("checks.png");
        WritePng(file, texels, 4, 4);
        parameters.push_back(StringParameter("filename", file));
        texture = builder.Add(true, "imagemap", std::move(parameters));
    }
    TextureTable Build(TextureFiltering filtering) {
        TextureTable table(builder.description, builder.warnings, filtering);
        builder.warnings.ThrowErrors();
        return table;
    }
};

TEST(FilteredImageMap, SeesTheFootprint) {
    for (const bool trilinear : {false, true}) {
        Checks checks({BoolParameter("trilinear", trilinear)});
        const TextureTable table = checks.Build(TextureFiltering::PbrtV3);
        const SpectrumTexture texture = checks.builder.Spectrum(table, checks.texture);
        EXPECT_EQ(table.Needs(texture), kNeedsUv | kNeedsFootprint);
        TextureContext at = At(0.375f, 0.125f);  // amid a texel
        const float fine = table.Evaluate(texture, at).x();
        at.dpdx = at.dpdy = Vec3f(1, 1, 0);
        EXPECT_EQ(table.Evaluate(texture, at).x(), fine);  // not a part of the texture
        at.duvdx = {1, 0};
        at.duvdy = {0, 1};
        EXPECT_NEAR(table.Evaluate(texture, at).x(), 0.5f, 1e-5f);
        at.duvdx = {0.25f, 0};
        at.duvdy = {0, 0.25f};
        const float blurred = table.Evaluate(texture, at).x();
        if (trilinear)
            EXPECT_EQ(blurred, fine);  // interpolates as the finest level does by itself
        else
            EXPECT_NEAR(blurred, 0.5f + (fine - 0.5f) * 0.2f, 0.2f);
        EXPECT_TRUE(fine == 0 || fine == 1) << fine;
    }
}

TEST(FilteredImageMap, IsNotThereUnlessAskedFor) {
    Checks checks({FloatParameter("maxanisotropy", {-3})});
    const TextureTable table = checks.Build(TextureFiltering::Bilinear);
    EXPECT_EQ(table.Needs(checks.builder.Spectrum(table, checks.texture)), kNeedsUv);
    EXPECT_EQ(table.Bytes(), 16u);
    const std::string error = ErrorOf([&] { checks.Build(TextureFiltering::PbrtV3); });
    EXPECT_TRUE(Contains(error, "scene.pbrt:10")) << error;
    EXPECT_TRUE(Contains(error, "\"maxanisotropy\" has to be above 0 and at most 1024")) << error;
}

TEST(FilteredImageMap, SharesPyramids) {
    Checks checks({});
    checks.builder.description.textures.push_back(checks.builder.description.textures[0]);
    EXPECT_EQ(checks.Build(TextureFiltering::PbrtV3).Bytes(), (16 + 4 + 1) * sizeof(float));
    checks.builder.description.textures.back().parameters.Add(FloatParameter("scale", {2}));
    EXPECT_EQ(checks.Build(TextureFiltering::PbrtV3).Bytes(), 2 * (16 + 4 + 1) * sizeof(float));
}

}  // namespace
}  // namespace lull
