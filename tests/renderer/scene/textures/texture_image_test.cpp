#include <gtest/gtest.h>

#include "renderer/base/math.h"
#include "renderer/image/image_io.h"
#include "renderer/scene/textures/imagemap.h"
#include "renderer/scene/textures/texture_image.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/scene/textures/texture_builder.h"

namespace lull {
namespace {

Parameter Filename(const std::string& name) { return String("filename", name); }

void ExpectRgb(const Rgb& a, const Rgb& b, float tolerance = 1e-6f) {
    EXPECT_LE((a - b).abs().maxCoeff(), tolerance) << a.transpose() << " | " << b.transpose();
}

// What the bytes of kTexels mean, and files that say the same in several formats.
struct ImageFiles {
    TemporaryDirectory directory;
    std::string tga, exrHalf, exrFloat, png, grey;

    // 3x2, the upper row first.
    static constexpr int kWidth = 3, kHeight = 2;
    std::vector<Rgb> encoded;

    ImageFiles() {
        const uint8_t bytes[6][3] = {{0, 10, 20},   {200, 30, 40},   {255, 255, 255},
                                     {64, 128, 32}, {100, 110, 120}, {1, 2, 3}};
        std::string texels;
        std::vector<Rgb> linear;
        for (const auto& b : bytes) {
            for (int c = 2; c >= 0; --c) texels += char(b[c]);
            encoded.push_back(Rgb(b[0], b[1], b[2]) / 255);
            linear.push_back(encoded.back().unaryExpr([](float v) { return LinearFromSrgb(v); }));
        }
        tga = directory.Write("a.tga",
                              std::string("\0\0\2\0\0\0\0\0\0\0\0\0\3\0\2\0\x18\x20", 18) + texels);
        grey = directory.Write(
            "grey.tga", std::string("\0\0\3\0\0\0\0\0\0\0\0\0\2\0\1\0\x08\x20", 18) + "\x40\x80");
        png = directory.File("a.png");
        WritePng(png, linear, kWidth, kHeight);
        exrHalf = WriteAsExr("half.exr", true);
        exrFloat = WriteAsExr("float.exr", false);
    }

    std::string WriteAsExr(const std::string& name, bool isHalf) const {
        ExrImage image{kWidth, kHeight, Vec2i::Zero(), {0, 0}, {}, {}};
        for (int c = 0; c < 3; ++c) {
            ExrChannel channel{std::string(1, "RGB"[c]), {}, isHalf};
            for (const Rgb& v : encoded) channel.values.push_back(v[c]);
            image.channels.push_back(std::move(channel));
        }
        WriteExr(directory.File(name), image);
        return directory.File(name);
    }

    // Returns the encoded value of the texel with (0, 0) at the lower left.
    Rgb At(int x, int y) const { return encoded[size_t((kHeight - 1 - y) * kWidth + x)]; }
};

// Evaluates an imagemap made with these parameters at uv.
Rgb EvaluateSpectrum(std::vector<Parameter> parameters, float u, float v) {
    TextureBuilder builder;
    const int texture = builder.Add(true, "imagemap", std::move(parameters));
    const TextureTable table = builder.Build();
    EXPECT_EQ(builder.warnings.Total(), 0);
    return table.Evaluate(builder.Spectrum(table, texture), At(u, v));
}
float EvaluateFloat(std::vector<Parameter> parameters, float u, float v) {
    TextureBuilder builder;
    const int texture = builder.Add(false, "imagemap", std::move(parameters));
    const TextureTable table = builder.Build();
    return table.Evaluate(builder.Float(table, texture), At(u, v));
}

Rgb Linear(const Rgb& c) {
    return c.unaryExpr([](float v) { return LinearFromSrgb(v); });
}

// The centres of the texels.
float U(int x) { return (float(x) + 0.5f) / ImageFiles::kWidth; }
float V(int y) { return (float(y) + 0.5f) / ImageFiles::kHeight; }

TEST(ImageMap, ReadsEveryFormatFromTheLowerLeft) {
    const ImageFiles files;
    const Parameter raw = Bool("gamma", false);
    for (int y = 0; y < files.kHeight; ++y)
        for (int x = 0; x < files.kWidth; ++x) {
            const Rgb expected = files.At(x, y);
            ExpectRgb(EvaluateSpectrum({Filename(files.tga), raw}, U(x), V(y)), expected, 1e-5f);
            ExpectRgb(EvaluateSpectrum({Filename(files.png), raw}, U(x), V(y)), expected, 1e-5f);
            ExpectRgb(EvaluateSpectrum({Filename(files.exrFloat)}, U(x), V(y)), expected, 1e-5f);
            ExpectRgb(EvaluateSpectrum({Filename(files.exrHalf)}, U(x), V(y)), expected, 5e-4f);
        }
}

TEST(ImageMap, LinearisesThenScales) {
    const ImageFiles files;
    const Rgb texel = files.At(1, 0);
    const Parameter scale = Float("scale", 3);
    for (const std::string& file : {files.tga, files.png})
        ExpectRgb(EvaluateSpectrum({Filename(file), scale}, U(1), V(0)), 3 * Linear(texel), 1e-5f);
    ExpectRgb(EvaluateSpectrum({Filename(files.exrFloat), scale}, U(1), V(0)), 3 * texel, 1e-5f);
    for (const std::string& file : {files.exrHalf, files.exrFloat})
        ExpectRgb(EvaluateSpectrum({Filename(file), scale, Bool("gamma", true)}, U(1), V(0)),
                  3 * Linear(texel), 2e-3f);
}

TEST(ImageMap, TakesLuminanceBeforeLinearising) {
    const ImageFiles files;
    const float luminance = Luminance(files.At(1, 1));  // (200, 30, 40)
    const Parameter scale = Float("scale", 2);
    EXPECT_NEAR(EvaluateFloat({Filename(files.tga), scale}, U(1), V(1)),
                2 * LinearFromSrgb(luminance), 1e-5f);
    EXPECT_NEAR(EvaluateFloat({Filename(files.exrFloat), scale}, U(1), V(1)), 2 * luminance, 1e-5f);
    EXPECT_NEAR(EvaluateFloat({Filename(files.exrHalf)}, U(1), V(1)), luminance, 5e-4f);
}

TEST(ImageMap, InterpolatesLinearValues) {
    const ImageFiles files;
    // Between four centres, a quarter of the way right and up: after linearisation.
    const float u = U(0) + 0.25f / files.kWidth, v = V(0) + 0.25f / files.kHeight;
    const Rgb expected =
        0.75f * 0.75f * Linear(files.At(0, 0)) + 0.25f * 0.75f * Linear(files.At(1, 0)) +
        0.75f * 0.25f * Linear(files.At(0, 1)) + 0.25f * 0.25f * Linear(files.At(1, 1));
    ExpectRgb(EvaluateSpectrum({Filename(files.tga)}, u, v), expected, 1e-5f);
}

TEST(ImageMap, Wraps) {
    const ImageFiles files;
    const auto at = [&](const char* wrap, float u, float v) {
        return EvaluateSpectrum({Filename(files.exrFloat), String("wrap", wrap)}, u, v);
    };
    // On the left edge, half of the texel beyond it counts.
    ExpectRgb(at("repeat", 0, V(0)), 0.5f * (files.At(0, 0) + files.At(2, 0)), 1e-5f);
    ExpectRgb(at("clamp", 0, V(0)), files.At(0, 0), 1e-5f);
    ExpectRgb(at("black", 0, V(0)), 0.5f * files.At(0, 0), 1e-5f);
    // On the upper edge likewise.
    ExpectRgb(at("repeat", U(1), 1), 0.5f * (files.At(1, 0) + files.At(1, 1)), 1e-5f);
    ExpectRgb(at("clamp", U(1), 1), files.At(1, 1), 1e-5f);
    ExpectRgb(at("black", U(1), 1), 0.5f * files.At(1, 1), 1e-5f);
    // Far outside.
    ExpectRgb(at("repeat", U(1) - 7, V(1) + 4), files.At(1, 1), 1e-5f);
    ExpectRgb(at("clamp", -7, 9), files.At(0, 1), 1e-5f);
    ExpectRgb(at("black", U(1) - 7, V(1)), Rgb::Zero());
    ExpectRgb(at("black", U(1), 1e30f), Rgb::Zero());
}

TEST(ImageMap, SharesImages) {
    const ImageFiles files;
    TextureBuilder builder;
    builder.Add(true, "imagemap", {Filename(files.tga)});
    const size_t once = builder.Build().Bytes();
    EXPECT_EQ(once, 3u * 2 * 3);
    builder.Add(
        true, "imagemap",
        {Filename(files.tga), Float("uscale", 3), Float("scale", 2), String("wrap", "clamp")});
    EXPECT_EQ(builder.Build().Bytes(), once);
    builder.Add(true, "imagemap", {Filename(files.grey)});
    builder.Add(false, "imagemap", {Filename(files.grey)});
    EXPECT_EQ(builder.Build().Bytes(), once + 2);
}

TEST(ImageMap, FoldsUniformImages) {
    const TemporaryDirectory directory;
    const std::string file = directory.File("uniform.png");
    WritePng(file, std::vector<Rgb>(6, Rgb(1, 0, 0.25f)), 3, 2);
    TextureBuilder builder;
    const int folded = builder.Add(true, "imagemap", {Filename(file), Float("scale", 0.5f)});
    const int black = builder.Add(true, "imagemap", {Filename(file), String("wrap", "black")});
    const int luminance = builder.Add(false, "imagemap", {Filename(file), Bool("gamma", false)});
    const TextureTable table = builder.Build();
    const SpectrumTexture texture = builder.Spectrum(table, folded);
    EXPECT_TRUE(texture.IsConstant());
    ExpectRgb(texture.constant, {0.5f, 0, 0.5f * LinearFromSrgb(137 / 255.f)});
    EXPECT_FALSE(table.Needs(texture) & kNeedsUv);
    EXPECT_FALSE(builder.Spectrum(table, black).IsConstant());
    EXPECT_NEAR(builder.Float(table, luminance).constant, Luminance({1, 0, 137 / 255.f}), 1e-6f);
}

TEST(ImageMap, CountsWhatIsNotFiniteAsZero) {
    const TemporaryDirectory directory;
    const std::string file = directory.File("bad.exr");
    ExrImage image;
    image.width = 2;
    image.height = 1;
    for (const char* name : {"R", "G", "B"})
        image.channels.push_back({name, {.5f, name[0] == 'G' ? kInfinity : NAN}, false});
    WriteExr(file, image);
    TextureBuilder builder;
    const int texture = builder.Add(true, "imagemap", {Filename(file), String("wrap", "clamp")});
    const TextureTable table = builder.Build();
    const SpectrumTexture map = builder.Spectrum(table, texture);
    ExpectRgb(table.Evaluate(map, At(.9f, .5f)), Rgb::Zero());
    ExpectRgb(table.Evaluate(map, At(.5f, .5f)), Rgb::Constant(.25f));
    EXPECT_EQ(builder.warnings.Total(), 1);
}

TEST(ImageMap, SaysWhichTextureCannotBeRead) {
    TextureBuilder strict, builder(true);
    for (TextureBuilder* b : {&strict, &builder}) {
        b->description.directory = "/nowhere";
        b->Add(true, "imagemap", {Filename("none.png"), Float("scale", 2)});
        b->Add(false, "imagemap", {Filename("none.exr")});
        b->Add(false, "imagemap", {});
    }
    const std::string error = ErrorOf([&] { strict.Build(); });
    EXPECT_HAS(error, "scene.pbrt:10: texture \"t0\"");
    EXPECT_HAS(error, "/nowhere/none.png");
    EXPECT_HAS(error, "no such file");
    EXPECT_HAS(error, "\nscene.pbrt:11: texture \"t1\"");
    EXPECT_HAS(error, "\nscene.pbrt:12: texture \"t2\"");

    // pbrt-v3 converts its grey like a texel.
    const TextureTable table = builder.Build();
    ExpectRgb(builder.Spectrum(table, 0).constant, Rgb::Constant(2 * LinearFromSrgb(0.5f)));
    EXPECT_EQ(builder.Float(table, 1).constant, 0.5f);
    EXPECT_EQ(builder.warnings.Total(), 3);
}

TEST(ImageMap, AcceptsFilteringParameters) {
    const ImageFiles files;
    TextureBuilder builder;
    builder.Add(true, "imagemap",
                {Filename(files.tga), Bool("trilinear", true), Float("maxanisotropy", 16),
                 String("wrap", "mirror")});
    builder.Build();
    EXPECT_EQ(builder.warnings.Total(), 1);  // of the wrap mode
}

TEST(MakeTextureImage, ReducesToOneChannel) {
    const Image grey{2, 1, 3, std::vector<float>{1, 1, 1, 2, 2, 2}};
    EXPECT_TRUE(MakeTextureImage(grey, 1, TextureChannels::Rgb).IsGrey());
    const Image greyAlpha{2, 1, 2, std::vector<uint8_t>{51, 9, 102, 8}};
    const TextureImage stripped = MakeTextureImage(greyAlpha, 1, TextureChannels::Rgb);
    EXPECT_EQ(std::get<0>(stripped.texels).values, (std::vector<uint8_t>{51, 102}));
    const Image rgba{1, 1, 4, std::vector<uint8_t>{1, 2, 3, 0}};
    EXPECT_EQ(MakeTextureImage(rgba, kSrgb, TextureChannels::Rgb).Bytes(), 3u);
    EXPECT_EQ(MakeTextureImage(rgba, kSrgb, TextureChannels::Luminance).Bytes(), 4u);
}

TEST(MakeTextureImage, TakesOneChannelAsItIs) {
    const Image rgba{1, 1, 4, std::vector<uint8_t>{10, 20, 30, 40}};
    const Image grey{1, 1, 1, std::vector<float>{0.25f}};
    const auto value = [](const Image& image, TextureChannels channel, float gamma = 1) {
        return MakeTextureImage(image, gamma, channel).uniform->x();
    };
    EXPECT_FLOAT_EQ(value(rgba, TextureChannels::Red), 10 / 255.f);
    EXPECT_FLOAT_EQ(value(rgba, TextureChannels::Green), 20 / 255.f);
    EXPECT_FLOAT_EQ(value(rgba, TextureChannels::Blue), 30 / 255.f);
    EXPECT_FLOAT_EQ(value(rgba, TextureChannels::Alpha, kSrgb), 40 / 255.f);
    EXPECT_FLOAT_EQ(value(grey, TextureChannels::Green), 0.25f);
    EXPECT_FLOAT_EQ(value(grey, TextureChannels::Alpha), 1);
    // pbrt-v4's number of an image: alpha, if there is any, or the mean.
    EXPECT_FLOAT_EQ(value(rgba, TextureChannels::MeanOrAlpha), 40 / 255.f);
    const Image opaque{1, 1, 4, std::vector<uint8_t>{10, 20, 30, 255}};
    EXPECT_FLOAT_EQ(value(opaque, TextureChannels::MeanOrAlpha), 20 / 255.f);
    EXPECT_FLOAT_EQ(value(opaque, TextureChannels::MeanOrAlpha, 2), 1400 / 3.f / (255 * 255));
}

TEST(BilinearFootprint, MirrorsEveryOtherCopy) {
    // Two texels, 0 and 1: from 0.25 to 0.75 the value grows, and falls again from 1.25 to 1.75.
    const auto value = [](float s, Wrap wrapS, Wrap wrapT) {
        const Footprint f = BilinearFootprint({0.5f, s}, 1, 2, wrapT, wrapS);
        return f.w01 * float(f.y1) + f.w00 * float(f.y0);
    };
    for (const float s : {0.1f, 0.3f, 0.5f, 0.9f, 1.f}) {
        const float expected = std::clamp(2 * s - 0.5f, 0.f, 1.f);
        for (const float moved : {s, 2 - s, -s, s + 2, s - 4})
            EXPECT_NEAR(value(moved, Wrap::Mirror, Wrap::Clamp), expected, 1e-6f) << moved;
    }
    EXPECT_NEAR(value(1.f, Wrap::Repeat, Wrap::Mirror), 0.5f, 1e-6f);
}

TEST(BilinearRgb, DoesNotFlipAndRepeats) {
    const Image image{2, 2, 3, std::vector<float>{1, 0, 0, 2, 0, 0, 3, 0, 0, 4, 0, 0}};
    EXPECT_EQ(BilinearRgb(image, {0.25f, 0.25f}, Wrap::Repeat, Wrap::Repeat).x(), 1);
    EXPECT_EQ(BilinearRgb(image, {0.75f, 0.25f}, Wrap::Repeat, Wrap::Repeat).x(), 2);
    EXPECT_EQ(BilinearRgb(image, {0.25f, 0.75f}, Wrap::Repeat, Wrap::Repeat).x(), 3);
    EXPECT_EQ(BilinearRgb(image, {0.5f, 0.5f}, Wrap::Repeat, Wrap::Repeat).x(), 2.5f);
    EXPECT_EQ(BilinearRgb(image, {0, 0.25f}, Wrap::Repeat, Wrap::Repeat).x(), 1.5f);
    EXPECT_EQ(BilinearRgb(image, {1, 1}, Wrap::Repeat, Wrap::Repeat).x(), 2.5f);
    EXPECT_EQ(BilinearRgb(image, {-0.25f, 1.25f}, Wrap::Repeat, Wrap::Repeat).x(), 2);
}

TEST(BilinearRgb, ReadsEveryForm) {
    const Image bytes{1, 1, 4, std::vector<uint8_t>{51, 102, 255, 7}};
    ExpectRgb(BilinearRgb(bytes, {0.1f, 0.9f}, Wrap::Repeat, Wrap::Repeat), {0.2f, 0.4f, 1});
    const Image halves{1, 1, 3, std::vector<Half>{Half(0.5f), Half(1000), Half(6e-8f)}};
    ExpectRgb(BilinearRgb(halves, {0.1f, 0.9f}, Wrap::Clamp, Wrap::Clamp), {0.5f, 1000, 0x1p-24f});
    const Image grey{1, 1, 1, std::vector<float>{3}};
    ExpectRgb(BilinearRgb(grey, {0.1f, 0.9f}, Wrap::Repeat, Wrap::Repeat), {3, 3, 3});
}

}  // namespace
}  // namespace lull
