// Checks learning and guided rendering as a whole: the same mean, less variance, the same bits.
#include "renderer/render/guide_learning.h"

#include <gtest/gtest.h>

#include <atomic>

#include "renderer/film/layers.h"
#include "renderer/input/pbrt_parser.h"
#include "renderer/render/guide_learning_state.h"
#include "renderer/render/render.h"
#include "renderer/scene/compile.h"
#include "tests/renderer/files/test_files.h"

namespace lull {
namespace {

std::unique_ptr<const Scene> MakeScene(const std::string& world, int size = 16,
                                       const std::string& camera = "0 0 -0.9  0 0 0  0 1 0",
                                       int maxDepth = 100, const std::string& integrator = "path") {
    const TemporaryDirectory directory;
    Warnings warnings;
    const std::string text = "LookAt " + camera + "\nCamera \"perspective\" \"float fov\" [80]\n" +
                             "Film \"image\" \"integer xresolution\" [" + std::to_string(size) +
                             "] \"integer yresolution\" [" + std::to_string(size) + "]\n" +
                             "Integrator \"" + integrator + "\" \"integer maxdepth\" [" +
                             std::to_string(maxDepth) + "]\nWorldBegin\n" + world + "\nWorldEnd\n";
    const Description d = ParsePbrt(directory.Write("test.pbrt", text), warnings);
    CompileOptions options;
    options.threads = 1;
    return Compile(d, options, warnings);
}

// A closed room with walls of several materials, lit by a lamp that shines at its ceiling alone.
constexpr const char* kRoom = R"(
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [90 80 60]
  Translate .6 .6 .6  Rotate -90 1 0 0
  Material "matte"
  Shape "disk" "float radius" [.12]
AttributeEnd
Material "matte" "rgb Kd" [.7 .7 .7]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3 4 5 6 4 6 7]
  "point P" [-1 1 -1  1 1 -1  1 1 1  -1 1 1   -1 -1 1  1 -1 1  1 1 1  -1 1 1]
Material "plastic" "rgb Kd" [.4 .3 .2] "rgb Ks" [.2 .2 .2] "float roughness" [.1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3 4 5 6 4 6 7]
  "point P" [-1 -1 -1  1 -1 -1  1 -1 1  -1 -1 1   -1 -1 -1  1 -1 -1  1 1 -1  -1 1 -1]
Material "uber" "rgb Kd" [.3 .4 .5] "rgb Ks" [.1 .1 .1] "rgb Kr" [.1 .1 .1]
Shape "trianglemesh" "integer indices" [0 1 2 0 2 3 4 5 6 4 6 7]
  "point P" [-1 -1 -1  -1 -1 1  -1 1 1  -1 1 -1   1 -1 -1  1 -1 1  1 1 1  1 1 -1]
AttributeBegin
  Translate -.4 -.6 .3
  Material "glass"
  Shape "sphere" "float radius" [.3]
AttributeEnd
AttributeBegin
  Translate .3 -.7 .2
  Material "metal" "float roughness" [.05]
  Shape "sphere" "float radius" [.3]
AttributeEnd
)";

PixelRect RegionOf(const Scene& scene) { return {scene.film.cropMin, scene.film.cropMax}; }

LearningOptions OptionsFor(GuideMode mode, int cap = 500) {
    LearningOptions options;
    options.mode = mode;
    options.sampler = SamplerKind::Random;
    options.threads = 2;
    options.cap = cap;
    return options;
}

Learning LearnAll(const Scene& scene, const LearningOptions& options) {
    Learning learning;
    EXPECT_TRUE(Learn(scene, RegionOf(scene), options, &learning));
    return learning;
}

// Returns all but the time it took.
std::vector<std::byte> BytesOf(Learning learning) {
    learning.figures.seconds = 0;
    return SaveLearning(learning);
}

struct Estimate {
    double mean = 0, variance = 0;  // of the mean of all pixels; of a sample, in all pixels
    double error = 0;
    int rejected = 0;
};

Estimate Measure(const Scene& scene, const SampleSource& source, int spp, uint64_t seed) {
    Estimate e;
    Sampler sampler(SamplerKind::Random, seed);
    const PixelRect region = RegionOf(scene);
    for (int y = 0; y < region.Height(); ++y)
        for (int x = 0; x < region.Width(); ++x) {
            double sum = 0, squares = 0;
            for (int k = 0; k < spp; ++k) {
                const PathSample sample = source(sampler, {x, y}, uint32_t(k));
                e.rejected += sample.rejected;
                const double value = double(sample.radiance.y());
                sum += value;
                squares += value * value;
            }
            e.mean += sum / spp;
            e.variance += (squares - sum * sum / spp) / (spp - 1);
        }
    const double pixels = double(region.Area());
    e.error = std::sqrt(e.variance / spp) / pixels;
    e.mean /= pixels;
    return e;
}

TEST(Learning, WithoutAnythingToSayPathsAreThoseWithout) {
    const auto scene = MakeScene(kRoom);
    const Guide nothing(scene->shapes.bounds, 2, 2);
    Sampler a(SamplerKind::Sobol, 1), b(SamplerKind::Sobol, 1);
    int differ = 0;  // where rounding ends one path earlier
    for (int k = 0; k < 500; ++k) {
        const Vec2i pixel(k % 16, k / 16 % 16);
        const Rgb guided = RenderSample(*scene, nothing, a, pixel, uint32_t(k)).radiance;
        const Rgb plain = RenderSample(*scene, Estimator::Combined, b, pixel, uint32_t(k)).radiance;
        differ += !((guided - plain).abs() <= 1e-3f * plain + 1e-6f).all();
    }
    EXPECT_LE(differ, 5);
}

TEST(Learning, KeepsTheMeanAndLowersTheVariance) {
    const auto scene = MakeScene(kRoom, 32);
    const Learning learning = LearnAll(*scene, OptionsFor(GuideMode::On, 1100));
    ASSERT_TRUE(learning.figures.isUsed);
    EXPECT_EQ(learning.figures.rounds, 6);  // 4 + 8 + ... + 128 of at most 1100 / 4 spp
    const Estimate plain = Measure(*scene, SamplesOf(*scene, Estimator::Combined), 60, 5);
    const Estimate guided = Measure(*scene, SamplesOf(*scene, learning.guide), 60, 6);
    EXPECT_EQ(guided.rejected, 0);
    EXPECT_NEAR(guided.mean, plain.mean, 4 * std::hypot(plain.error, guided.error));
    EXPECT_LT(guided.variance, 0.8 * plain.variance);
}

// A ball of fog in that room, and fog about the camera.
TEST(Learning, KeepsTheMeanInMedia) {
    const std::string fog =
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.05 .1 .2] "
        "\"rgb sigma_s\" [.4 .3 .2] \"float g\" .3\n";
    const std::string ball =
        "AttributeBegin\nMaterial \"none\"\nMediumInterface \"fog\" \"\"\n"
        "Shape \"sphere\" \"float radius\" .6\nAttributeEnd\n";
    const std::string view = "0 0 -0.9  0 0 0  0 1 0\n";
    const auto inside =
        MakeScene(kRoom, 16, view + fog + "MediumInterface \"\" \"fog\"", 30, "volpath");
    const auto outside = MakeScene(fog + ball + kRoom, 16, view, 30, "volpath");
    for (const Scene* scene : {inside.get(), outside.get()}) {
        ASSERT_TRUE(scene->isVolumetric);
        ASSERT_FALSE(WhyNotGuided(*scene, Estimator::Combined));
        const Learning learning = LearnAll(*scene, OptionsFor(GuideMode::On, 500));
        const Estimate pbrt = Measure(*scene, SamplesOf(*scene, Estimator::PbrtV3), 200, 4);
        const Estimate plain = Measure(*scene, SamplesOf(*scene, Estimator::Combined), 120, 5);
        const Estimate guided = Measure(*scene, SamplesOf(*scene, learning.guide), 120, 6);
        EXPECT_EQ(guided.rejected, 0);
        EXPECT_NEAR(guided.mean, plain.mean, 4 * std::hypot(plain.error, guided.error));
        EXPECT_NEAR(guided.mean, pbrt.mean, 4 * std::hypot(pbrt.error, guided.error));
    }
}

// Asking for layers changes no guided sample, and what is seen first does not depend on the guide,
// in mirrors and through glass neither.
TEST(Learning, LayersAreThoseWithout) {
    const auto scene = MakeScene(kRoom);
    const Learning learning = LearnAll(*scene, OptionsFor(GuideMode::On, 250));
    ASSERT_TRUE(learning.figures.isUsed);
    for (const bool throughSpecular : {false, true}) {
        const AovSet wanted{.depth = true, .throughSpecular = throughSpecular};
        const AovSource guided = AovSamplesOf(*scene, learning.guide, wanted),
                        plain = AovSamplesOf(*scene, Estimator::Combined, wanted);
        Sampler a(SamplerKind::Sobol, 1), b = a, c = a;
        for (uint32_t k = 0; k < 1000; ++k) {
            const Vec2i pixel(int(k % 16), int(k / 16 % 16));
            FirstHit hit, usual;
            const Rgb with = guided(a, pixel, k, &hit).radiance,
                      without = SamplesOf(*scene, learning.guide)(b, pixel, k).radiance;
            for (int channel = 0; channel < 3; ++channel)
                ASSERT_EQ(with[channel], without[channel]);
            plain(c, pixel, k, &usual);
            ASSERT_EQ(hit.found, usual.found);
            ASSERT_EQ(hit.object, usual.object);
            ASSERT_EQ(hit.material, usual.material);
            ASSERT_NEAR(hit.depth, usual.depth, 1e-4f);
            ASSERT_TRUE(hit.albedo.isApprox(usual.albedo, 1e-4f)) << k;
            ASSERT_TRUE(hit.normal.isApprox(usual.normal, 1e-4f));
        }
    }
    // Noise needs no first hits.
    Sampler a(SamplerKind::Sobol, 1), b = a;
    const AovSource noise = AovSamplesOf(*scene, learning.guide, {.noise = true});
    FirstHit hit;
    EXPECT_EQ(noise(a, {3, 4}, 5, &hit).radiance.x(),
              SamplesOf(*scene, learning.guide)(b, {3, 4}, 5).radiance.x());
    EXPECT_FALSE(hit.found);
}

// Inside a closed sphere of albedo r that emits e, radiance is e / (1 - r) everywhere.
TEST(Learning, Furnace) {
    for (const char* material :
         {"\"matte\" \"rgb Kd\" [.8 .8 .8]", "\"mirror\" \"rgb Kr\" [.8 .8 .8]"}) {
        const auto scene =
            MakeScene(std::string("AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\nMaterial ") +
                          material + "\nReverseOrientation\nShape \"sphere\" \"float radius\" [2]",
                      8, "0.3 0.2 -1  0 0 0  0 1 0", 1000);
        const Learning learning = LearnAll(*scene, OptionsFor(GuideMode::On));
        const Estimate e = Measure(*scene, SamplesOf(*scene, learning.guide), 400, 3);
        EXPECT_NEAR(e.mean, 5, 4.5 * e.error + 1e-3) << material;
        EXPECT_EQ(e.rejected, 0);
    }
}

// Lamps that are small and bright make fireflies of what the guide records.
TEST(Learning, WithstandsFireflies) {
    const auto scene = MakeScene(std::string(kRoom) + R"(
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [1e12 1e12 1e12]
  Translate -.5 .2 .5
  Shape "sphere" "float radius" [1e-5]
AttributeEnd)");
    const Learning learning = LearnAll(*scene, OptionsFor(GuideMode::On, 100));
    ASSERT_TRUE(learning.figures.isUsed);
    const Estimate e = Measure(*scene, SamplesOf(*scene, learning.guide), 20, 2);
    EXPECT_EQ(e.rejected, 0);
    EXPECT_TRUE(std::isfinite(e.mean) && std::isfinite(e.variance));
}

TEST(Learning, IsTheSameOnAnyNumberOfThreads) {
    const auto scene = MakeScene(kRoom, 24);
    for (const GuideMode mode : {GuideMode::On, GuideMode::Auto}) {
        LearningOptions options = OptionsFor(mode, mode == GuideMode::On ? 120 : 1000);
        std::vector<std::byte> expected;
        for (const int threads : {1, 2, 4}) {
            options.threads = threads;
            const auto bytes = BytesOf(LearnAll(*scene, options));
            if (expected.empty()) expected = bytes;
            EXPECT_TRUE(bytes == expected) << threads;
        }
    }
}

TEST(Learning, GoesOnToTheSameBits) {
    const auto scene = MakeScene(kRoom);
    LearningOptions options = OptionsFor(GuideMode::On, 250);
    const auto expected = BytesOf(LearnAll(*scene, options));
    // Interrupted in every round, after some tiles.
    std::vector<std::byte> kept;
    int interruptions = 0;
    for (bool isDone = false; !isDone;) {
        Learning learning;
        if (!kept.empty()) learning = RestoreLearning(kept);
        std::atomic<int> rounds = 0, asked = 0;
        options.isCancelled = [&] { return rounds > 0 && ++asked > 2; };
        isDone = Learn(*scene, RegionOf(*scene), options, &learning, [&](const Learning& l) {
            ++rounds;
            kept = SaveLearning(l);
        });
        if (isDone) {
            EXPECT_TRUE(BytesOf(learning) == expected);
        } else {
            ++interruptions;
        }
    }
    EXPECT_EQ(interruptions, 3);  // of 4 rounds, all but the last
}

TEST(Learning, SavedStateIsChecked) {
    const auto scene = MakeScene(kRoom);
    std::vector<std::byte> bytes;
    Learning learning;
    Learn(*scene, RegionOf(*scene), OptionsFor(GuideMode::On, 60), &learning,
          [&](const Learning& l) { bytes = SaveLearning(l); });
    ASSERT_FALSE(bytes.empty());
    EXPECT_NO_THROW(RestoreLearning(bytes));
    for (const size_t size : {size_t(0), size_t(3), size_t(40), bytes.size() / 2, bytes.size() - 1})
        EXPECT_THROW(RestoreLearning(std::span(bytes).first(size)), std::runtime_error) << size;
    // What is taken nevertheless can be walked through.
    uint64_t state = 1;
    int refused = 0;
    for (int i = 0; i < 300; ++i) {
        std::vector<std::byte> damaged = bytes;
        for (int k = 0; k < 4; ++k) {
            state = state * 6364136223846793005ull + 1442695040888963407ull;
            damaged[(state >> 20) % damaged.size()] = std::byte(state >> 56);
        }
        try {
            const Guide guide = RestoreLearning(damaged).state.guide;
            for (int k = 0; k < 50; ++k) {
                const float u = float(k) / 50;
                const GuideLeaf& leaf = guide.Leaf(guide.Find({u, -u, u}));
                float pdf;
                const Vec3f w = guide.Sample(leaf, {u, 1 - 0.9f * u}, &pdf);
                EXPECT_TRUE(guide.Pdf(leaf, w) >= 0);
            }
        } catch (const std::runtime_error&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 0);
}

TEST(Learning, KeepsToItsMemory) {
    const auto scene = MakeScene(kRoom, 64);
    LearningOptions options = OptionsFor(GuideMode::On, 250);
    options.megabytes = 2;
    Learning learning;
    EXPECT_TRUE(Learn(*scene, RegionOf(*scene), options, &learning, [](const Learning& l) {
        EXPECT_LE(l.state.guide.Bytes() + l.state.record.Bytes(), 1u << 20);
    }));
    EXPECT_LE(learning.guide.Bytes(), 1u << 20);
    EXPECT_TRUE(learning.figures.isUsed);
}

TEST(Learning, AutoGuidesWhereThatPays) {
    // Nothing but sky above a floor: light sampling finds all there is.
    const auto floor = MakeScene(
        "LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial \"matte\"\n"
        "Shape \"disk\" \"float radius\" [10]",
        64, "0 0 2  0.1 0 0  0 0 1");
    const Learning plain = LearnAll(*floor, OptionsFor(GuideMode::Auto, 10000));
    EXPECT_FALSE(plain.figures.isUsed);
    EXPECT_GT(plain.figures.rounds, 0);
    EXPECT_TRUE(plain.guide.nodes.empty());

    const auto room = MakeScene(kRoom, 64);
    const Learning learning = LearnAll(*room, OptionsFor(GuideMode::Auto, 10000));
    EXPECT_TRUE(learning.figures.isUsed) << learning.figures.variance;
    EXPECT_LT(learning.figures.variance + 2 * learning.figures.varianceError, 0.9);

    const Learning few = LearnAll(*room, OptionsFor(GuideMode::Auto, 64));
    EXPECT_FALSE(few.figures.isUsed);
    EXPECT_EQ(few.figures.samples, 0);
}

TEST(Learning, SaysWhereItCannotGuide) {
    const auto room = MakeScene(kRoom);
    EXPECT_FALSE(WhyNotGuided(*room, Estimator::Combined));
    EXPECT_TRUE(WhyNotGuided(*room, Estimator::PbrtV3));
    EXPECT_TRUE(WhyNotGuided(*MakeScene("Shape \"sphere\""), Estimator::Combined));
    EXPECT_TRUE(
        WhyNotGuided(*MakeScene(kRoom, 16, "0 0 -0.9  0 0 0  0 1 0", 1), Estimator::Combined));
    // A scene whose lamp nobody sees.
    const auto dark = MakeScene(
        "LightSource \"point\" \"rgb I\" [0 0 0]\nMaterial \"matte\"\n"
        "Shape \"sphere\"");
    const Learning learning = LearnAll(*dark, OptionsFor(GuideMode::On));
    EXPECT_FALSE(learning.figures.isUsed);
    EXPECT_FALSE(learning.figures.why.empty());
}

}  // namespace
}  // namespace lull
