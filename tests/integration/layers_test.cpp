// Layers beside the image, read by OpenEXR itself as compositors do, and how pictures are stored.
#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfInputFile.h>
#include <ImfStringAttribute.h>
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numeric>
#include <set>

#include "renderer/base/math.h"
#include "renderer/image/image_io.h"
#include "tests/integration/run_lull.h"
#include "tests/renderer/film/viewer_server.h"

namespace lull {
namespace {

constexpr const char* kAll = "--aov albedo,normal,depth,position,object,material,noise ";

// A sky, a point light, and a lamp over a ball.
constexpr const char* kLamps = R"(
LightSource "point" "point from" [2 1 -2] "rgb I" [2 1 1] "string lightgroup" "key"
AttributeBegin
MakeNamedMaterial "bulb" "string type" "matte"
NamedMaterial "bulb"
AreaLightSource "diffuse" "rgb L" [6 7 9]
Translate -1.2 1 0
Shape "sphere" "float radius" .3
AttributeEnd
Shape "sphere" "float radius" .8
)";

// A file as OpenEXR reads it.
struct OpenExr {
    Imf::InputFile file;
    int width, height;

    explicit OpenExr(const std::string& path) : file(path.c_str()) {
        const Imath::Box2i window = file.header().dataWindow();
        width = window.max.x - window.min.x + 1;
        height = window.max.y - window.min.y + 1;
    }

    // Lists "name:type" of all channels, in the order of the alphabet, as OpenEXR keeps them.
    std::string Channels() {
        std::string list;
        const Imf::ChannelList& channels = file.header().channels();
        for (auto c = channels.begin(); c != channels.end(); ++c)
            list +=
                fmt::format("{}:{} ", c.name(), c.channel().type == Imf::HALF ? "half" : "float");
        return list;
    }
    std::vector<float> Channel(const std::string& name) {
        std::vector<float> values(size_t(width) * size_t(height));
        Imf::FrameBuffer frame;
        frame.insert(name, Imf::Slice::Make(Imf::FLOAT, values.data(), file.header().dataWindow()));
        file.setFrameBuffer(frame);
        file.readPixels(file.header().dataWindow().min.y, file.header().dataWindow().max.y);
        return values;
    }
    std::string Text(const std::string& attribute) {
        return file.header().typedAttribute<Imf::StringAttribute>(attribute).value();
    }
    float At(const std::string& name, int x, int y) {
        return Channel(name).at(size_t(y) * size_t(width) + size_t(x));
    }
};

struct LayersTest : testing::Test {
    LayersTest() {
        directory.Write("scene.pbrt",
                        SceneText("MakeNamedMaterial \"clay\" \"string type\" \"matte\" \"rgb Kd\" "
                                  "[.2 .4 .6]\nNamedMaterial \"clay\"\nShape \"sphere\""));
    }
    void Render(const std::string& options) {
        ExpectSuccess(directory, "render scene.pbrt --quiet " + options);
    }
    std::vector<float> Values(const std::string& file, const std::string& channel) {
        return ReadExr(directory.File(file)).Find(channel)->values;
    }
    double MeanOf(const std::string& file, const std::string& channel) {
        const std::vector<float> values = Values(file, channel);
        return std::accumulate(values.begin(), values.end(), 0.) / double(values.size());
    }
    // Expects that the light of groups adds up to R, G, B, within rounding and `tolerance` times
    // the brightest value.
    void ExpectSum(const std::string& file, const std::vector<std::string>& groups,
                   float tolerance = 1e-6f) {
        const ExrImage image = ReadExr(directory.File(file));
        for (const std::string channel : {"R", "G", "B"}) {
            const std::vector<float>& whole = image.Find(channel)->values;
            std::vector<float> sum(whole.size());
            for (const std::string& group : groups) {
                const ExrChannel* part = image.Find("light." + group + "." + channel);
                ASSERT_TRUE(part) << group;
                EXPECT_GT(std::ranges::max(part->values), 0.01f) << group;
                std::ranges::transform(sum, part->values, sum.begin(), std::plus());
            }
            const float most = tolerance * std::ranges::max(whole);
            for (size_t i = 0; i < sum.size(); ++i) ASSERT_NEAR(sum[i], whole[i], most) << file;
        }
    }
    bool SameChannels(const std::string& a, const std::string& b) {
        const ExrImage x = ReadExr(directory.File(a)), y = ReadExr(directory.File(b));
        bool same = x.channels.size() == y.channels.size();
        for (size_t i = 0; same && i < x.channels.size(); ++i)
            same = x.channels[i].name == y.channels[i].name &&
                   x.channels[i].values == y.channels[i].values;
        return same;
    }
    TemporaryDirectory directory;
};

TEST_F(LayersTest, HaveTheNamesThatOtherProgramsRead) {
    Render(std::string("--spp 16 -o a.exr ") + kAll);
    OpenExr exr(directory.File("a.exr"));
    EXPECT_EQ(exr.Channels(),
              "B:float G:float N.X:float N.Y:float N.Z:float P.X:float P.Y:float P.Z:float R:float "
              "Z:float albedo.B:float albedo.G:float albedo.R:float materialID:float noise:float "
              "objectID:float spp:float ");
    // The middle of the sphere, seen from z = -3.
    const int x = exr.width / 2, y = exr.height / 2;
    EXPECT_NEAR(exr.At("Z", x, y), 2, 0.02f);
    EXPECT_NEAR(exr.At("P.Z", x, y), -1, 0.02f);
    EXPECT_NEAR(exr.At("N.Z", x, y), -1, 0.02f);
    EXPECT_NEAR(exr.At("albedo.R", x, y), 0.2f, 1e-5f);
    EXPECT_NEAR(exr.At("albedo.B", x, y), 0.6f, 1e-5f);
    EXPECT_EQ(exr.At("objectID", x, y), 1);
    const float material = exr.At("materialID", x, y);
    EXPECT_EQ(exr.Text("objectNames"), "{\"1\":\"sphere, scene.pbrt:9\"}");
    EXPECT_EQ(exr.Text("materialNames"), fmt::format("{{\"{}\":\"clay\"}}", material));
    EXPECT_GT(exr.At("noise", x, y), 0);
    EXPECT_LT(exr.At("noise", x, y), 20);
    // The white sky beside it.
    EXPECT_EQ(exr.At("Z", 0, 0), 1e10f);
    EXPECT_EQ(exr.At("albedo.R", 0, 0), 1);
    EXPECT_EQ(exr.At("N.Z", 0, 0), 0);
    EXPECT_EQ(exr.At("objectID", 0, 0), 0);
    EXPECT_NEAR(exr.At("noise", 0, 0), 0, 1e-3f);
}

TEST_F(LayersTest, OfLightGroupsAddUpToTheImage) {
    directory.Write("scene.pbrt", SceneText(kLamps));
    const std::string groups = "--light-groups bulb,key ";
    Render("--spp 40 -o plain.exr");
    Render("--spp 40 -o a.exr " + groups);
    EXPECT_EQ(OpenExr(directory.File("a.exr")).Text("lightGroups"), "bulb,key,rest");
    ExpectSum("a.exr", {"bulb", "key", "rest"});
    EXPECT_EQ(Values("a.exr", "G"), Values("plain.exr", "G"));
    EXPECT_EQ(directory.Bytes("a.png"), directory.Bytes("plain.png"));
    Render("--spp 40 --denoise --aov albedo -o denoised.exr " + groups);
    ExpectSum("denoised.exr", {"bulb", "key", "rest"});
    EXPECT_EQ(Values("denoised.exr", "noisy.G"), Values("plain.exr", "G"));
    Render("--spp 40 --estimator pbrt-v3 -o b.exr --light-groups each");
    ExpectSum("b.exr", {"environment", "key", "bulb"});
    // Light paths belong to the group of the light that they start from.
    Render("--spp 40 --integrator bdpt -o e.exr");
    Render("--spp 40 --integrator bdpt --aov noise -o f.exr " + groups);
    ExpectSum("f.exr", {"bulb", "key", "rest"});
    EXPECT_EQ(Values("f.exr", "G"), Values("e.exr", "G"));
    for (const char* group : {"light.bulb.G", "light.key.G", "light.rest.G"})
        EXPECT_NEAR(MeanOf("f.exr", group) / MeanOf("a.exr", group), 1, 0.05) << group;
    Render("--spp 40 --integrator bdpt --denoise -o g.exr " + groups);
    ExpectSum("g.exr", {"bulb", "key", "rest"});
    Render("--spp 40 --exr-half -o d.exr " + groups);
    ExpectSum("d.exr", {"bulb", "key", "rest"}, 2e-3f);
    EXPECT_HAS(OpenExr(directory.File("d.exr")).Channels(), "light.key.G:half");
}

// Names of channels are UTF-8 of up to 255 bytes; those of lights can be anything.
TEST_F(LayersTest, OfLightGroupsHaveNamesThatEveryoneReads) {
    const std::string letters = "\xc3\xa4", broken =
                                                "k\xff\xfe"
                                                "y";
    std::string longName;
    for (int i = 0; i < 150; ++i) longName += letters;
    const auto lamp = [](const std::string& name) {
        return "LightSource \"point\" \"point from\" [0 2 -2] \"rgb I\" [9 9 9] "
               "\"string lightgroup\" \"" +
               name + "\"\n";
    };
    directory.Write("scene.pbrt",
                    SceneText(lamp(longName) + lamp(longName + "b") + lamp(broken) + kSphere));
    Render("--spp 4 --light-groups each -o out.exr");
    std::set<std::string> layers;
    for (const ExrChannel& channel : ReadExr(directory.File("out.exr")).channels) {
        EXPECT_LE(channel.name.size(), 255u);
        // Throws for what is not UTF-8.
        EXPECT_NO_THROW(nlohmann::json(channel.name).dump());
        if (channel.name.starts_with("light.") && channel.name.ends_with(".R"))
            layers.insert(channel.name);
        if (channel.name.starts_with("light.k")) {
            EXPECT_TRUE(
                channel.name.starts_with("light.k\xef\xbf\xbd\xef\xbf\xbd"
                                         "y."));
        }
    }
    EXPECT_EQ(layers.size(), 4u);  // these and the sky
    EXPECT_TRUE(layers.contains("light." + longName.substr(0, 238) + "~1.R"));
    EXPECT_TRUE(layers.contains("light." + longName.substr(0, 238) + "~2.R"));
}

TEST_F(LayersTest, OfLightGroupsAreRefusedWhereTheyCannotBe) {
    directory.Write("scene.pbrt", SceneText(kLamps));
    const std::string render = "render scene.pbrt -o out.exr --light-groups ";
    ExpectFailure(directory, render + "key,lamp",
                  {"--light-groups", "\"lamp\"", "there are: environment, key, delta, bulb, area"});
    ExpectFailure(directory, render + "rest", {"--light-groups", "\"rest\"", "leave it out"});
}

TEST_F(LayersTest, LetTheBackgroundOut) {
    Render("--spp 16 -o with.exr");
    Render("--spp 16 --transparent -o without.exr");
    OpenExr with(directory.File("with.exr")), without(directory.File("without.exr"));
    EXPECT_EQ(without.Channels(), "A:float B:float G:float R:float spp:float ");
    const std::vector<float> alpha = without.Channel("A"), all = with.Channel("R"),
                             left = without.Channel("R");
    Render("--spp 16 --transparent --aov cryptomatte -o mattes.exr");
    const std::vector<float> share =  // of the only object
        OpenExr(directory.File("mattes.exr")).Channel("CryptoObject00.G");
    EXPECT_HAS(directory.Bytes("mattes.exr"), std::string("/manifest\0string\0", 17));
    bool isPartial = false;
    for (size_t i = 0; i < alpha.size(); ++i) {
        // The sky is white.
        EXPECT_NEAR(left[i], all[i] - (1 - alpha[i]), 1e-5f);
        EXPECT_NEAR(share[i], alpha[i], 1e-5f);
        isPartial |= alpha[i] > 0 && alpha[i] < 1;
    }
    EXPECT_TRUE(isPartial);
    EXPECT_EQ(ReadImage(directory.File("without.png")).channels, 4);
}

// The samples' own picture is the same one as the denoised, noisy.
TEST_F(LayersTest, LetTheBackgroundOutOfTheSamplesToo) {
    Render("--spp 16 --sampler sobol --denoise --transparent -o denoised.exr");
    Render("--spp 16 --sampler sobol --transparent -o noisy.exr");
    for (const std::string c : {"R", "G", "B"})
        EXPECT_EQ(Values("denoised.exr", "noisy." + c), Values("noisy.exr", c));
}

TEST_F(LayersTest, HalfIsForColours) {
    Render(std::string("--spp 4 --exr-half -o a.exr ") + kAll);
    OpenExr exr(directory.File("a.exr"));
    EXPECT_EQ(
        exr.Channels(),
        "B:half G:half N.X:half N.Y:half N.Z:half P.X:float P.Y:float P.Z:float R:half Z:float "
        "albedo.B:half albedo.G:half albedo.R:half materialID:float noise:float "
        "objectID:float spp:float ");
}

TEST_F(LayersTest, RulesSeeThePictureAsItIsShown) {
    const auto stops = [&](const std::string& options) {
        Render("--resolution 64x64 --cap 600 " + options + " -o a.exr");
        return ReadExr(directory.File("a.exr"));
    };
    const auto sppOf = [](const ExrImage& exr) { return exr.Find("spp")->values[0]; };
    directory.Write("scene.pbrt", SceneText(kLamps));
    // Dark noise, which hardly anybody sees.
    const std::string dark = "--stop entropy:0.2 --exposure -6 ";
    const ExrImage plain = stops(dark), lifted = stops(dark + "--graded-by 4"),
                   shown = stops(dark + "--view-exposure 4");
    EXPECT_GT(sppOf(lifted), sppOf(plain));
    EXPECT_EQ(sppOf(lifted), sppOf(shown));
    EXPECT_EQ(plain.attributes.count("judgedGrades"), 0u);
    EXPECT_EQ(std::get<std::string>(lifted.attributes.at("judgedGrades")), "sRGB; +4 stops");
    EXPECT_EQ(std::get<std::string>(shown.attributes.at("judgedGrades")), "+4 stops");
}

TEST_F(LayersTest, PicturesAreBrightenedForTheView) {
    Render("--spp 4 -o a.exr");
    Render("--spp 4 --view-exposure -1 -o b.exr");
    EXPECT_TRUE(SameChannels("a.exr", "b.exr"));
    const Image png = ReadImage(directory.File("b.png"));
    const auto& shown = std::get<std::vector<uint8_t>>(png.texels);
    const std::vector<float> green = Values("a.exr", "G");
    for (size_t i = 0; i < green.size(); ++i)
        ASSERT_NEAR(shown[3 * i + 1], 255 * SrgbFromLinear(std::min(1.f, green[i] / 2)), 0.51f);
}

// The view of this test halves all colours.
TEST_F(LayersTest, PicturesAreMappedByOpenColorIo) {
    directory.Write("half.ocio", R"(ocio_profile_version: 1
roles: {scene_linear: lin, default: lin}
displays: {screen: [!<View> {name: plain, colorspace: lin}, !<View> {name: half, colorspace: dim}]}
colorspaces:
  - !<ColorSpace> {name: lin, bitdepth: 32f}
  - !<ColorSpace>
    name: dim
    bitdepth: 32f
    from_reference: !<MatrixTransform> {matrix: [0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1]}
)");
    const std::string ocio = "--spp 4 --ocio " + directory.File("half.ocio");
    Render(ocio + " --view half -o a.exr");
    EXPECT_EQ(OpenExr(directory.File("a.exr")).Text("pngToneMap"), "OpenColorIO screen/half");
    const Image png = ReadImage(directory.File("a.png"));
    const auto& shown = std::get<std::vector<uint8_t>>(png.texels);
    const std::vector<float> green = Values("a.exr", "G");
    for (size_t i = 0; i < green.size(); ++i)
        ASSERT_NEAR(shown[3 * i + 1], 255 * std::clamp(green[i] / 2, 0.f, 1.f), 0.51f);
    Render(ocio + " --view half --transparent --png-bits 16 -o b.exr");
    EXPECT_EQ(ReadImage(directory.File("b.png")).channels, 4);
    const Outcome unknown =
        RunLull(directory, "render scene.pbrt -o c.exr " + ocio + " --view filmic");
    EXPECT_EQ(unknown.exitCode, 1);
    EXPECT_HAS(unknown.err, "no view \"filmic\", but: plain, half");
    EXPECT_EQ(RunLull(directory, "render scene.pbrt --ocio no.ocio").exitCode, 1);
}

// Of configurations that are no text, too.
TEST_F(LayersTest, MessagesOfOpenColorIoCanBePrinted) {
    directory.Write("raw.ocio", "ocio_profile_version: 1\n\xff\x01\x1b[31mx: [\n: \x80");
    for (const char* view : {"--ocio raw.ocio", "--ocio raw.ocio --view \xff\x1b[31m"}) {
        const Outcome bad = RunLull(directory, "render scene.pbrt -o c.exr " + std::string(view));
        EXPECT_EQ(bad.exitCode, 1);
        EXPECT_HAS(bad.err, "raw.ocio");
        for (const char c : bad.err) EXPECT_TRUE((c >= ' ' && c < 0x7f) || c == '\n') << bad.err;
    }
}

// What a viewer has put together at the end is what is in the file, for rules that look at blocks
// of the denoised picture, and for others.
TEST_F(LayersTest, ViewersSeeTheImage) {
    const auto view = [&](const std::string& rule) {
        ViewerServer server;
        Render("--resolution 100x80 --block 40 --threads 2 -o a.exr " + rule + " --display " +
               server.Address());
        EXPECT_EQ(server.Finish().size(), 1u);
        const ViewedImage viewed = Reassemble(server.Finish().at(0));
        EXPECT_EQ(viewed.name, "a.exr");
        const ExrImage image = ReadExr(directory.File("a.exr"));
        for (const char* name : {"R", "G", "B", "spp"})
            EXPECT_EQ(viewed.channels.at(name), image.Find(name)->values) << name;
        return viewed.channels.at("stop");
    };
    EXPECT_EQ(view("--stop dammertz:0.02 --cap 300"), std::vector<float>(100 * 80, 1.f));
    view("--denoise --cap 100");
}

}  // namespace
}  // namespace lull
