// Denoises renders: by the render itself, afterwards, and those of others.
#include <map>
#include <nlohmann/json.hpp>

#include "renderer/image/image_io.h"
#include "tests/integration/run_and_signal.h"

namespace lull {
namespace {

constexpr const char* kBall =
    "Material \"matte\" \"rgb Kd\" [.7 .5 .3]\n"
    "Shape \"sphere\"\n"
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [30 25 20] Translate 0 2 0\n"
    "Shape \"sphere\" \"float radius\" .1 AttributeEnd\n"
    "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3]\n"
    "  \"point P\" [-5 -1 -5  5 -1 -5  5 -1 5  -5 -1 5]";
const std::string kDenoiseBox =
    "render scene.pbrt --resolution 96x80 --block 48 --denoise --stop denoised:0.7 --cap 400 ";
// Goes on long after its first checkpoint, on any machine.
const std::string kLongDenoiseBox =
    "render scene.pbrt --resolution 96x80 --block 48 --denoise --stop denoised:0.2 --cap 400 "
    "--quiet ";

struct BoxDirectory : TemporaryDirectory {
    BoxDirectory() { Write("scene.pbrt", SceneText(kBall)); }
};

using Channels = std::map<std::string, std::vector<float>>;
Channels ChannelsOf(const TemporaryDirectory& directory, const std::string& name) {
    Channels channels;
    for (const ExrChannel& c : ReadExr(directory.File(name)).channels) channels[c.name] = c.values;
    return channels;
}

TEST(DenoiseOption, ImagesHaveWhatTheSamplesSayToo) {
    const BoxDirectory directory;
    ExpectSuccess(directory, kDenoiseBox + "-o clean.exr --report clean.json");
    const Channels clean = ChannelsOf(directory, "clean.exr");
    ASSERT_TRUE(clean.contains("noisy.R") && clean.contains("error"));
    for (const std::string name : {"R", "G", "B"}) {
        EXPECT_NE(clean.at(name), clean.at("noisy." + name));
        for (const float v : clean.at(name)) EXPECT_TRUE(v >= 0 && std::isfinite(v));
    }
    for (const float e : clean.at("error")) EXPECT_TRUE(e >= 0 && std::isfinite(e));

    // The mean of the samples is that of a render that knows nothing of all this.
    ExpectSuccess(directory,
                  "render scene.pbrt --resolution 96x80 --block 48 "
                  "--sampler sobol-halves "
                  "--stop thresholds:clean.thresholds.csv -o plain.exr");
    const Channels plain = ChannelsOf(directory, "plain.exr");
    for (const std::string name : {"R", "G", "B"})
        EXPECT_EQ(clean.at("noisy." + name), plain.at(name));
    EXPECT_EQ(clean.at("spp"), plain.at("spp"));
}

TEST(DenoiseOption, WarnsOfHalvesThatDependOnEachOther) {
    const BoxDirectory directory;
    for (const char* sampler : {"sobol", "sobol-halves", "random"}) {
        const Outcome outcome = ExpectSuccess(
            directory, fmt::format("render scene.pbrt --resolution 16x16 --spp 4 --denoise "
                                   "--sampler {} -o a.exr",
                                   sampler));
        EXPECT_EQ(Contains(outcome.err, "complement each other"), sampler == std::string("sobol"))
            << outcome.err;
    }
}

// Nothing is said of a stopped block that its threshold contradicts.
TEST(DenoiseOption, StoppedBlocksHaveTheErrorThatStoppedThem) {
    const BoxDirectory directory;
    // The whole picture says 3.2.
    ExpectSuccess(directory,
                  "render scene.pbrt --resolution 60x60 --block 60 --denoise --seed 6 -o a.exr "
                  "--report a.json");
    const auto report = nlohmann::json::parse(directory.Bytes("a.json"));
    const auto& block = report["blocks"][0];
    ASSERT_EQ(block["end"], "clean");
    EXPECT_EQ(block["visibleDifference"]["estimate"], block["decisions"]["value"].back());
    EXPECT_LE(block["visibleDifference"]["estimate"], block["decisions"]["threshold"]);
    EXPECT_LE(block["visibleDifference"]["estimate"], block["visibleDifference"]["upper"]);
}

// The denoiser looks through glass, whatever AOVs look at.
TEST(DenoiseOption, ImagesAreTheSameWithAovs) {
    const TemporaryDirectory directory;
    directory.Write("scene.pbrt", SceneText(std::string("Material \"glass\"\n") + kSphere +
                                            "\nTranslate 0 -2 0\n" + kBall));
    const std::string render =
        "render scene.pbrt --resolution 48x40 --block 24 --denoise --cap 100 --quiet -o ";
    ExpectSuccess(directory, render + "plain.exr");
    Channels plain = ChannelsOf(directory, "plain.exr");
    for (const std::string aovs :
         {"albedo,normal,depth", "noise,cryptomatte", "albedo,object --aov-through-specular"}) {
        ExpectSuccess(directory, render + "aovs.exr --aov " + aovs);
        const Channels with = ChannelsOf(directory, "aovs.exr");
        for (const auto& [name, values] : plain) EXPECT_EQ(with.at(name), values) << name << aovs;
    }
}

// Paths find a lamp behind glass by chance: few samples have all of the light, and both halves can
// look alike without being right.
TEST(DenoiseOption, BoundsTheErrorOfALampInGlass) {
    const TemporaryDirectory directory;
    directory.Write("scene.pbrt", R"(
LookAt 0 1 -4  0 .2 0  0 1 0
Camera "perspective" "float fov" [40]
Film "image" "integer xresolution" [80] "integer yresolution" [80]
WorldBegin
AttributeBegin
    Translate 0 .3 0
    AttributeBegin
        AreaLightSource "diffuse" "rgb L" [20 18 15]
        Material "matte" "rgb Kd" [0 0 0]
        Shape "sphere" "float radius" [.05]
    AttributeEnd
    Material "glass" "float eta" [1.5]
    Shape "sphere" "float radius" [.3]
AttributeEnd
Material "matte" "rgb Kd" [.6 .5 .4]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-4 -.3 -4 4 -.3 -4 4 -.3 4 -4 -.3 4]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3] "point P" [-4 -4 2 4 -4 2 4 4 2 -4 4 2]
WorldEnd
)");
    ExpectSuccess(directory,
                  "render scene.pbrt --integrator bdpt --max-depth 8 --spp 400 --quiet "
                  "-o truth.exr");
    ExpectSuccess(directory,
                  "render scene.pbrt --max-depth 8 --spp 400 --seed 1 --denoise --quiet -o a.exr "
                  "--report a.json");
    ExpectSuccess(directory, "compare --automatic a.exr --reference truth.exr --quiet -o compared");
    const auto report = nlohmann::json::parse(directory.Bytes("a.json"));
    const auto found = nlohmann::json::parse(directory.Bytes("compared.compare.json"));
    const double error = found["images"][0]["figures"]["visibleDifference"];
    EXPECT_GT(error, 3);
    EXPECT_GE(report["blocks"][0]["visibleDifference"]["upper"], error);
}

TEST(DenoiseOption, BitsAreThoseOfAnyThreadsAndInterruptions) {
    const BoxDirectory directory;
    const std::string layers =
        kLongDenoiseBox +
        "--aov albedo,normal,depth,position,object,material,noise,alpha,cryptomatte ";
    const std::string render = layers + "--light-groups area ";
    ExpectSuccess(directory, render + "-o whole.exr --threads 1");
    const Channels whole = ChannelsOf(directory, "whole.exr");

    const std::string parts = "-o parts.exr --threads 3 --checkpoint c.h5 ";
    const Outcome interrupted = RunAndSignal(
        directory, "LULL " + render + parts + "--checkpoint-interval 0.1", SIGTERM, "c.h5");
    ASSERT_EQ(interrupted.exitCode, 130) << interrupted.err;
    // What is interrupted is denoised as far as it has come.
    const Channels part = ChannelsOf(directory, "parts.exr");
    EXPECT_TRUE(part.contains("noisy.R"));
    for (size_t i = 0; i < part.at("spp").size(); ++i)
        if (part.at("spp")[i] == 0) {
            ASSERT_EQ(part.at("error")[i], 100);
        }
    ExpectFailure(directory, layers + "--light-groups environment " + parts + "--resume",
                  {"light group 00 is area,rest of", "here environment,rest of"});
    ExpectFailure(directory, render + parts + "--resume --aov-through-specular",
                  {"of the first surface", "here through mirrors and glass"});
    ExpectSuccess(directory, render + parts + "--resume");
    EXPECT_EQ(ChannelsOf(directory, "parts.exr"), whole);
}

TEST(DenoiseCommand, GivesWhatTheRenderGives) {
    const BoxDirectory directory;
    ExpectSuccess(directory, kDenoiseBox + "-o image.exr --denoise-layers");
    ExpectSuccess(directory, "denoise image.exr -o again.exr");
    const Channels image = ChannelsOf(directory, "image.exr"),
                   again = ChannelsOf(directory, "again.exr");
    for (const std::string name : {"R", "G", "B"}) {
        const std::vector<float>&a = image.at(name), &b = again.at(name);
        for (size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 2e-3f * (0.05f + a[i]));
    }
    EXPECT_EQ(image.at("noisy.G"), again.at("noisy.G"));
}

// No error is said to be 0 that nobody knows.
TEST(DenoiseOption, ClaimsNothingThatItCannotKnow) {
    const BoxDirectory directory;
    ExpectFailure(directory, "render scene.pbrt --spp 3 --denoise-layers -o out.exr",
                  {"--spp 3", "4"}, 2);
    const Outcome few = ExpectSuccess(directory, "render scene.pbrt --spp 1 --denoise -o few.exr");
    EXPECT_HAS(few.err, "fewer than 4 samples");
    const Outcome small =
        ExpectSuccess(RunShell(directory,
                               "LULL render scene.pbrt --spp 20 --denoise --resolution 8x8 "
                               "-o a.exr --report a.json"));
    EXPECT_HAS(small.err, "unknown: blocks have less than 10 pixels a side");
    EXPECT_EQ(RunShell(directory, "grep visibleDifference a.json").exitCode, 1);
}

TEST(DenoiseCommand, SaysWhatIsMissing) {
    const BoxDirectory directory;
    ExpectSuccess(directory, "render scene.pbrt --spp 20 -o a.exr");
    ExpectSuccess(directory, "render scene.pbrt --spp 20 --resolution 30x30 -o b.exr");
    ExpectFailure(directory, "denoise a.exr -o out.exr", {"a.exr", "--denoise-layers"});
    ExpectFailure(directory, "denoise a.exr --half b.exr -o out.exr", {"b.exr", "30x30"});
    ExpectFailure(directory, "denoise scene.pbrt -o out.exr", {"scene.pbrt"});
    ExpectFailure(directory, "denoise missing.exr -o out.exr", {"missing.exr"});
    ExpectFailure(directory, "denoise a.exr --half a.exr -o out.exr", {"a.exr", "same"});
    ExpectFailure(directory, "render scene.pbrt -o out.exr --stop denoised", {"--denoise"}, 2);
    ExpectSuccess(RunShell(directory, "cp a.exr again.exr"));
    ExpectFailure(directory, "denoise a.exr --half again.exr -o out.exr",
                  {"again.exr", "the same colours", "--seed"});
}

// Two halves of an image of other programs: 0.2 to the left, 0.6 to the right, and noise.
void WriteHalves(const TemporaryDirectory& directory, const std::vector<std::string>& names) {
    uint32_t state = 1;
    for (const char* file : {"a.exr", "b.exr"}) {
        ExrImage exr{64, 48, Vec2i(3, 2), {100, 80}, {}, {}};
        for (const std::string& name : names) {
            ExrChannel& channel = exr.channels.emplace_back(ExrChannel{name, {}});
            for (int i = 0; i < 64 * 48; ++i) {
                state = state * 1664525 + 1013904223;
                const float noise = 1 + 0.3f * (float(state >> 8) * 0x1p-23f - 1);
                channel.values.push_back((i % 64 < 32 ? 0.2f : 0.6f) * noise);
            }
        }
        WriteExr(directory.File(file), exr);
    }
}

TEST(DenoiseCommand, KnowsTheChannelsOfOthers) {
    const TemporaryDirectory directory;
    const std::string layer = "ViewLayer.", combined = layer + "Combined.";
    for (const std::vector<std::string>& names :
         {std::vector<std::string>{"R", "G", "B"},
          {combined + "R", combined + "G", combined + "B", combined + "A"},
          {combined + "R", combined + "G", combined + "B", layer + "Denoising Albedo.R",
           layer + "Denoising Albedo.G", layer + "Denoising Albedo.B", layer + "Denoising Normal.X",
           layer + "Denoising Normal.Y", layer + "Denoising Normal.Z", layer + "Denoising Depth.Z",
           layer + "DiffDir.R", layer + "DiffDir.G", layer + "DiffDir.B"},
          {"beauty.R", "beauty.G", "beauty.B"},
          {"Y"}}) {
        SCOPED_TRACE(names.back());
        WriteHalves(directory, names);
        ExpectSuccess(directory, "denoise a.exr --half b.exr -o out.exr");
        const Channels out = ChannelsOf(directory, "out.exr");
        for (const std::string channel : {"R", "G", "B"}) {
            double error = 0, before = 0;
            for (size_t i = 0; i < 64 * 48; ++i) {
                const double truth = i % 64 < 32 ? 0.2 : 0.6;
                error += Sqr(double(out.at(channel)[i]) - truth);
                before += Sqr(double(out.at("noisy." + channel)[i]) - truth);
            }
            EXPECT_LT(error, before / 3) << channel;
        }
        const bool hasFeatures = names.size() > 10;
        EXPECT_EQ(out.contains("albedo.G") && out.contains("N.X") && out.contains("Z"),
                  hasFeatures);
        EXPECT_EQ(ReadExr(directory.File("out.exr")).origin, Vec2i(3, 2));
    }
    WriteHalves(directory, {"depth.V", "mask"});
    ExpectFailure(directory, "denoise a.exr --half b.exr -o out.exr",
                  {"no channels R, G and B, nor Y", "mask, depth.V"});
    WriteHalves(directory, {"a.R", "a.G", "a.B", "b.R", "b.G", "b.B"});
    ExpectFailure(directory, "denoise a.exr --half b.exr -o out.exr", {"several layers", "a.R"});
    ExpectFailure(directory, "denoise a.exr -o out.exr", {"half", "--half", "a.R"});
}

// Y of X, Y and Z is no grey value, and ACES' red is not that of displays.
TEST(DenoiseCommand, RefusesOtherColours) {
    const TemporaryDirectory directory;
    const std::string command = "denoise a.exr --half b.exr -o out.exr";
    WriteHalves(directory, {"X", "Y", "Z"});
    ExpectFailure(directory, command, {"a.exr", "another space", "X, Y, Z"});
    WriteHalves(directory, {"Y", "RY", "BY"});
    ExpectFailure(directory, command, {"a.exr", "another space", "RY"});
    WriteHalves(directory, {"C", "M", "Y", "K"});
    ExpectFailure(directory, command, {"a.exr", "another space", "C"});
    WriteHalves(directory, {"L", "a", "b"});
    ExpectFailure(directory, command, {"a.exr", "no channels R, G and B", "L"});
    WriteHalves(directory, {"Y", "Z"});  // grey, and depth
    ExpectSuccess(directory, command);
    EXPECT_EQ(RunLull(directory, "entropy a.exr --block 20").exitCode, 0);
    WriteHalves(directory, {"X", "Y", "Z"});
    ExpectFailure(directory, "entropy a.exr", {"a.exr", "X, Y, Z"});
}

TEST(DenoiseCommand, WritesNoColoursThatAreNotFinite) {
    const TemporaryDirectory directory;
    WriteHalves(directory, {"R", "G", "B", "albedo.R", "albedo.G", "albedo.B"});
    ExrImage exr = ReadExr(directory.File("a.exr"));
    for (ExrChannel& channel : exr.channels) {
        channel.values[100] = NAN;
        if (channel.name.size() == 1) channel.values[1000] = INFINITY;
    }
    WriteExr(directory.File("a.exr"), exr);
    ExpectSuccess(directory, "denoise a.exr --half b.exr -o out.exr");
    for (const auto& [name, values] : ChannelsOf(directory, "out.exr"))
        for (const float v : values) ASSERT_TRUE(std::isfinite(v)) << name;
}

}  // namespace
}  // namespace lull
