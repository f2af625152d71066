// Checks renders that learn which lights and tiles of the environment each place sees: the same
// mean, less variance.
#include "renderer/learning/light_learner.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <atomic>

#include "renderer/base/color.h"
#include "renderer/image/image_io.h"
#include "tests/renderer/learning/learning_render.h"
#include "tests/renderer/render/synthetic_samples.h"
#include "tests/renderer/scene_of.h"

namespace lull::light_learner_test {
namespace {

// A box that is open on one side, where the sky of a studio comes in, seen from there.
std::unique_ptr<const Scene> MakeRoom(int size, const std::string& integrator = "path",
                                      const std::string& things = "") {
    return SceneOf(WorldText(
        R"(
LightSource "infinite" "bool studio" "true"
Material "matte" "rgb Kd" [.7 .6 .5]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3 4 5 6 4 6 7]
  "point P" [-1 1 -1  1 1 -1  1 1 1  -1 1 1   -1 -1 1  1 -1 1  1 1 1  -1 1 1]
Material "plastic" "rgb Kd" [.4 .3 .2] "rgb Ks" [.2 .2 .2] "float roughness" [.1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3 4 5 6 4 6 7 8 9 10 8 10 11]
  "point P" [-1 -1 -1  1 -1 -1  1 -1 1  -1 -1 1   -1 -1 -1  -1 -1 1  -1 1 1  -1 1 -1
             1 -1 -1  1 -1 1  1 1 1  1 1 -1]
)" + things,
        fmt::format("LookAt 0 0 -.9  0 -.2 0  0 1 0\nCamera \"perspective\" \"float fov\" [80]\n"
                    "Film \"image\" \"integer xresolution\" [{0}] \"integer yresolution\" [{0}]\n"
                    "Integrator \"{1}\" \"integer maxdepth\" [6]",
                    size, integrator)));
}

constexpr const char* kFog = R"(
MakeNamedMedium "fog" "string type" "homogeneous" "rgb sigma_a" [.1 .1 .1] "rgb sigma_s" [2 2 2]
AttributeBegin
  MediumInterface "fog" ""
  Material ""
  Translate 0 -.3 .3
  Shape "sphere" "float radius" [.5]
AttributeEnd
)";

// Lamps in the room and behind two of its walls.
constexpr const char* kLamps = R"(
LightSource "point" "point from" [.5 .7 .5] "rgb I" [.3 .3 .3]
LightSource "point" "point from" [0 -1.2 .3] "rgb I" [3 3 3]
LightSource "point" "point from" [-1.5 0 .3] "rgb I" [3 3 3]
)";

// A room with lamps and no sky, or with both.
std::unique_ptr<const Scene> MakeLampRoom(int size, bool hasSky) {
    if (hasSky) return MakeRoom(size, "path", kLamps);
    return SceneOf(WorldText(std::string(kLamps) + R"(
Material "matte" "rgb Kd" [.7 .6 .5]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3 4 5 6 4 6 7]
  "point P" [-1 -1 -1  1 -1 -1  1 -1 1  -1 -1 1   -1 -1 -1  -1 -1 1  -1 1 1  -1 1 -1])",
                             fmt::format("LookAt 0 0 -.9  0 -.2 0  0 1 0\n"
                                         "Camera \"perspective\" \"float fov\" [80]\n"
                                         "Film \"image\" \"integer xresolution\" [{0}] "
                                         "\"integer yresolution\" [{0}]",
                                         size)));
}

RenderOptions OptionsFor(int spp, uint64_t seed, int threads = 2, int blockSize = 200) {
    RenderOptions options;
    options.schedule = {.blockSize = blockSize, .passLength = 20, .cap = spp};
    options.sampler = SamplerKind::Random;
    options.seed = seed;
    options.threads = threads;
    return options;
}

// A render that learns direct light, and guides no directions unless asked to.
struct DirectLightRender : LearningRender {
    DirectLightRender(const Scene& scene, const RenderOptions& o, GuideMode mode = GuideMode::Off)
        : LearningRender(scene, o, {.mode = mode, .directLight = true}) {}
};

struct Estimate {
    double mean = 0, error = 0;
    double variance = 0;  // of a render
};

// Returns what many renders, by seed, come to.
template <typename MeanOfRender>
Estimate Repeat(int count, const MeanOfRender& meanOf) {
    double sum = 0, squares = 0;
    for (int i = 0; i < count; ++i) {
        const double mean = meanOf(uint64_t(i));
        sum += mean;
        squares += mean * mean;
    }
    const double mean = sum / count,
                 variance = (squares / count - mean * mean) * count / (count - 1);
    return {mean, std::sqrt(variance / count), variance};
}

double MeanWithout(const Scene& scene, int spp, uint64_t seed) {
    const RenderOptions options = OptionsFor(spp, seed);
    Film film(RegionOf(scene), {.grid = GridOf(options.schedule)});
    Render({.source = SamplesOf(scene, Estimator::Combined), .film = &film}, options);
    return MeanOf(film);
}

// Compares renders that learn with such that do not; the variance is to be below `most` of theirs.
void CompareWithout(const Scene& scene, double most, const std::string& name) {
    const Estimate with = Repeat(60, [&](uint64_t seed) {
        DirectLightRender render(scene, OptionsFor(80, seed));
        render.Run();
        EXPECT_TRUE(render.learner.IsDone());
        return render.Mean();
    });
    const Estimate without =
        Repeat(60, [&](uint64_t seed) { return MeanWithout(scene, 80, seed + 1000); });
    EXPECT_NEAR(with.mean, without.mean, 4 * std::hypot(with.error, without.error)) << name;
    EXPECT_LT(with.variance, most * without.variance) << name;
}

TEST(LightLearner, KeepsTheMeanAndLowersTheVariance) {
    for (const auto& [integrator, things] :
         {std::pair("path", std::string()), std::pair("volpath", std::string(kFog))}) {
        const auto scene = MakeRoom(12, integrator, things);
        ASSERT_EQ(scene->isVolumetric, !things.empty());
        CompareWithout(*scene, 1.2, integrator);
    }
    CompareWithout(*MakeLampRoom(12, false), 0.8, "lamps");
    CompareWithout(*MakeLampRoom(12, true), 1, "lamps and a sky");
}

// A sun that shines through a small hole in a roof, and one behind the roof: what comes through the
// hole is known, and a sample is never much brighter than without anything learned.
TEST(LightLearner, ASunThatIsFoundLateIsNoFirefly) {
    const TemporaryDirectory directory;
    ExrImage sky;
    sky.width = 64;
    sky.height = 32;
    for (const char* channel : {"R", "G", "B"}) {
        sky.channels.push_back({channel, {}, false});
        sky.channels.back().values.resize(64 * 32);
        sky.channels.back().values[3 * 64 + 10] = 100;
        sky.channels.back().values[12 * 64 + 40] = 100;
    }
    WriteExr(directory.File("sun.exr"), sky);
    // A roof with a square hole of 0.1.
    const auto scene = SceneOf(
        WorldText(fmt::format(R"(
LightSource "infinite" "string mapname" "{}"
Material "matte" "rgb Kd" [.5 .5 .5]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3]
  "point P" [-9 -9 0  9 -9 0  9 9 0  -9 9 0]
Shape "trianglemesh" "integer indices" [0 1 5 0 5 4 1 2 6 1 6 5 2 3 7 2 7 6 3 0 4 3 4 7]
  "point P" [-40 -40 1.5  40 -40 1.5  40 40 1.5  -40 40 1.5
             -.05 -.05 1.5  .05 -.05 1.5  .05 .05 1.5  -.05 .05 1.5])",
                              directory.File("sun.exr")),
                  "LookAt 0 0 1  0 0 0  0 1 0\nCamera \"orthographic\"\n"
                  "Film \"image\" \"integer xresolution\" [32] \"integer yresolution\" [32]\n"
                  "Integrator \"path\" \"integer maxdepth\" [1]"));
    ASSERT_GE(scene->lights.Environment(), 0);

    // The light through the hole: its area times the irradiance of the sun that gets to the floor
    // in view, spread over its four units of area.
    double irradiance = 0;
    constexpr int kRows = 1000, kColumns = 2000;
    const auto& light = std::get<InfiniteLight>(scene->lights[scene->lights.Environment()]);
    for (int y = 0; y < kRows / 3; ++y)
        for (int x = 0; x < kColumns; ++x) {
            const double theta = (y + 0.5) / kRows * double(kPi);
            const double phi = (x + 0.5) / kColumns * 2 * double(kPi);
            if (std::tan(theta) * 1.5 > 1) continue;
            const Vec3f w(float(std::sin(theta) * std::cos(phi)),
                          float(std::sin(theta) * std::sin(phi)), float(std::cos(theta)));
            irradiance += double(light.LeAndPdf(w).L.y()) * std::cos(theta) * std::sin(theta) *
                          (double(kPi) / kRows) * (2 * double(kPi) / kColumns);
        }
    const double expected = 0.5 / double(kPi) * irradiance * 0.01 / 4;

    std::atomic<float> brightest = 0;
    const Estimate found = Repeat(15, [&](uint64_t seed) {
        DirectLightRender render(*scene, OptionsFor(200, seed, 1));
        const SampleSource source = render.source;
        render.source = [&](Sampler& s, const Vec2i& pixel, uint32_t index,
                            const SampleDetail& detail) {
            const PathSample sample = source(s, pixel, index, detail);
            brightest = std::max(brightest.load(), sample.radiance.y());
            return sample;
        };
        render.Run();
        return render.Mean();
    });
    EXPECT_NEAR(found.mean, expected, 4 * found.error);
    EXPECT_LT(found.error, 0.03 * expected);

    float brightestWithout = 0;
    Sampler sampler(SamplerKind::Random, 1);
    for (int k = 0; k < 200000; ++k)
        brightestWithout =
            std::max(brightestWithout, RenderSample(*scene, Estimator::Combined, sampler,
                                                    {k % 32, k / 32 % 32}, uint32_t(k / 1024))
                                           .radiance.y());
    EXPECT_LT(brightest.load(), 10 * brightestWithout);
}

TEST(LightLearner, NeedsAMapOrLightsByPlaceThatAreNotSampledAsByPbrt) {
    const auto room = MakeRoom(8);
    EXPECT_TRUE(LearnsDirectLight(*room, Estimator::Combined));
    EXPECT_FALSE(LearnsDirectLight(*room, Estimator::PbrtV3));
    const auto learns = [](const std::string& lights, CompileOptions options = {},
                           const std::string& integrator = "") {
        const auto scene = SceneOf(WorldText(lights + "Shape \"sphere\"", integrator), options);
        return LearnsDirectLight(*scene, Estimator::Combined);
    };
    EXPECT_FALSE(learns("LightSource \"infinite\"\n"));
    CompileOptions asPbrt;
    asPbrt.lightsAsPbrtV3 = true;
    EXPECT_FALSE(learns("LightSource \"infinite\" \"bool studio\" \"true\"\n", asPbrt));
    const std::string lamp = "LightSource \"point\" \"point from\" [0 0 5]\n";
    EXPECT_FALSE(learns(lamp));
    EXPECT_TRUE(learns(lamp + lamp));
    EXPECT_FALSE(
        learns(lamp + lamp, {}, "Integrator \"path\" \"string lightsamplestrategy\" \"power\"\n"));
    EXPECT_FALSE(learns(lamp + lamp, {}, "Integrator \"path\" \"integer maxdepth\" [0]\n"));
}

}  // namespace
}  // namespace lull::light_learner_test
