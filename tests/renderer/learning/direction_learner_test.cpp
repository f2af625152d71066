// Checks renders that learn a guide as they go on: the same mean, less variance, the same bits.
#include "renderer/learning/direction_learner.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/film/layers.h"
#include "renderer/render/render.h"
#include "tests/renderer/learning/learning_render.h"
#include "tests/renderer/render/synthetic_samples.h"
#include "tests/renderer/scene_of.h"

namespace lull {
namespace {

std::unique_ptr<const Scene> MakeScene(const std::string& world, int size = 16,
                                       const std::string& camera = "0 0 -0.9  0 0 0  0 1 0",
                                       int maxDepth = 100, const std::string& integrator = "path") {
    return SceneOf(WorldText(
        world, "LookAt " + camera + "\nCamera \"perspective\" \"float fov\" [80]\n" +
                   "Film \"image\" \"integer xresolution\" [" + std::to_string(size) +
                   "] \"integer yresolution\" [" + std::to_string(size) + "]\n" + "Integrator \"" +
                   integrator + "\" \"integer maxdepth\" [" + std::to_string(maxDepth) + "]"));
}

// A closed room with walls of several materials, lit by a lamp that shines at its ceiling alone.
constexpr const char* kWalls = R"(
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
)";
// With balls of glass and metal in it.
const std::string kRoom = kWalls + std::string(R"(
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
)");

RenderOptions RenderFor(int cap, uint64_t seed = 0, int threads = 2) {
    RenderOptions options;
    options.schedule = {.blockSize = 200, .passLength = 20, .cap = cap};
    options.sampler = SamplerKind::Random;
    options.seed = seed;
    options.threads = threads;
    return options;
}

struct Estimate {
    double mean = 0, variance = 0;  // of the mean of all pixels; of a sample, in all pixels
    double error = 0;
    double noise = 0;  // standard deviation of a sample, summed over all pixels
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
                const PathSample sample = source(sampler, {x, y}, uint32_t(k), {});
                e.rejected += sample.rejected;
                const double value = double(sample.radiance.y());
                sum += value;
                squares += value * value;
            }
            e.mean += sum / spp;
            const double variance = (squares - sum * sum / spp) / (spp - 1);
            e.variance += variance;
            e.noise += std::sqrt(std::max(0., variance));
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
    LearningRender render(*scene, RenderFor(300));
    render.Run();
    ASSERT_TRUE(render.learner.Figures().isUsed);
    EXPECT_EQ(render.learner.RoundEnd(), 512);
    EXPECT_EQ(render.learner.Figures().rounds, 6);  // of 4, 4 + 4, ..., up to 256 spp
    EXPECT_EQ(render.learner.Figures().samples, 252);
    const Estimate plain = Measure(*scene, SamplesOf(*scene, Estimator::Combined), 60, 5);
    const Estimate guided = Measure(*scene, SamplesOf(*scene, render.TheGuide()), 60, 6);
    EXPECT_EQ(guided.rejected, 0);
    EXPECT_NEAR(guided.mean, plain.mean, 4 * std::hypot(plain.error, guided.error));
    EXPECT_LT(guided.variance, 0.8 * plain.variance);
}

// All samples count, those of the first rounds too: the mean of images that each learned by itself
// is that of images that did not.
TEST(Learning, KeepsTheMeanOfTheWholeImage) {
    const auto scene = MakeScene(kRoom, 12);
    constexpr int kImages = 50, kSpp = 68;
    const Estimate plain = Measure(*scene, SamplesOf(*scene, Estimator::Combined), 2000, 1234);
    for (const SamplerKind sampler : {SamplerKind::Random, SamplerKind::Sobol}) {
        double sum = 0, squares = 0;
        for (uint64_t seed = 0; seed < kImages; ++seed) {
            RenderOptions options = RenderFor(kSpp, seed);
            options.sampler = sampler;
            LearningRender render(*scene, options);
            render.Run();
            sum += render.Mean();
            squares += Sqr(render.Mean());
        }
        const double mean = sum / kImages,
                     error = std::sqrt((squares / kImages - Sqr(mean)) / (kImages - 1));
        EXPECT_NEAR(mean, plain.mean, 3.5 * std::hypot(error, plain.error));
        EXPECT_LT(error, 0.015 * mean);
    }
}

// A ball of fog in the room, and fog about the camera.
TEST(Learning, KeepsTheMeanInMedia) {
    const std::string fog =
        "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [.05 .1 .2] "
        "\"rgb sigma_s\" [.4 .3 .2] \"float g\" .3\n";
    const std::string ball =
        "AttributeBegin\nMaterial \"none\"\nMediumInterface \"fog\" \"\"\n"
        "Shape \"sphere\" \"float radius\" .6\nAttributeEnd\n";
    const std::string view = "0 0 -0.9  0 0 0  0 1 0\n";
    const auto inside =
        MakeScene(kWalls, 32, view + fog + "MediumInterface \"\" \"fog\"", 30, "volpath");
    const auto outside = MakeScene(fog + ball + kWalls, 32, view, 30, "volpath");
    for (const Scene* scene : {inside.get(), outside.get()}) {
        ASSERT_TRUE(scene->isVolumetric);
        ASSERT_FALSE(WhyNotGuided(*scene, Estimator::Combined));
        LearningRender render(*scene, RenderFor(300));
        render.Run();
        const Estimate pbrt = Measure(*scene, SamplesOf(*scene, Estimator::PbrtV3), 80, 4);
        const Estimate plain = Measure(*scene, SamplesOf(*scene, Estimator::Combined), 60, 5);
        const Estimate guided = Measure(*scene, SamplesOf(*scene, render.TheGuide()), 60, 6);
        EXPECT_EQ(guided.rejected, 0);
        EXPECT_NEAR(guided.mean, plain.mean, 4 * std::hypot(plain.error, guided.error));
        EXPECT_NEAR(guided.mean, pbrt.mean, 4 * std::hypot(pbrt.error, guided.error));
        EXPECT_LT(guided.noise, 0.85 * plain.noise);
    }
}

// A large ball of wax in the room, smooth and rough: paths that leave it are guided.
TEST(Learning, KeepsTheMeanBelowSurfaces) {
    for (const char* rough : {"", "\"float uroughness\" .3 \"float vroughness\" .2"}) {
        const auto scene = MakeScene(
            fmt::format("{}AttributeBegin\nMaterial \"subsurface\" \"rgb sigma_a\" [.1 .2 "
                        ".4] \"rgb sigma_s\" [20 18 15] {}\nTranslate -.1 -.1 .4\n"
                        "Shape \"sphere\" \"float radius\" .6\nAttributeEnd\n",
                        kWalls, rough),
            32);
        LearningRender render(*scene, RenderFor(300));
        render.Run();
        const Estimate plain = Measure(*scene, SamplesOf(*scene, Estimator::Combined), 60, 5);
        const Estimate guided = Measure(*scene, SamplesOf(*scene, render.TheGuide()), 60, 6);
        EXPECT_EQ(guided.rejected, 0);
        EXPECT_NEAR(guided.mean, plain.mean, 4 * std::hypot(plain.error, guided.error));
        EXPECT_LT(guided.noise, 0.85 * plain.noise);
    }
}

// Asking for layers changes no guided sample, and what is seen first does not depend on the guide,
// in mirrors and through glass neither.
TEST(Learning, LayersAreThoseWithout) {
    const auto scene = MakeScene(kRoom);
    LearningRender render(*scene, RenderFor(64));
    render.Run();
    const Guide guide = render.TheGuide();
    for (const bool throughSpecular : {false, true}) {
        PathOptions guided = guide, plain = Estimator::Combined;
        guided.throughSpecular = plain.throughSpecular = throughSpecular;
        Sampler a(SamplerKind::Sobol, 1), b = a, c = a;
        for (uint32_t k = 0; k < 1000; ++k) {
            const Vec2i pixel(int(k % 16), int(k / 16 % 16));
            FirstHit hit, usual;
            const Rgb with = SamplesOf(*scene, guided)(a, pixel, k, {&hit}).radiance,
                      without = SamplesOf(*scene, guide)(b, pixel, k, {}).radiance;
            for (int channel = 0; channel < 3; ++channel)
                ASSERT_EQ(with[channel], without[channel]);
            SamplesOf(*scene, plain)(c, pixel, k, {&usual});
            ASSERT_EQ(hit.found, usual.found);
            ASSERT_EQ(hit.object, usual.object);
            ASSERT_EQ(hit.material, usual.material);
            ASSERT_NEAR(hit.depth, usual.depth, 1e-4f);
            ASSERT_TRUE(hit.albedo.isApprox(usual.albedo, 1e-4f)) << k;
            ASSERT_TRUE(hit.normal.isApprox(usual.normal, 1e-4f));
        }
    }
}

// Inside a closed sphere of albedo r that emits e, radiance is e / (1 - r) everywhere.
TEST(Learning, Furnace) {
    for (const char* material :
         {"\"matte\" \"rgb Kd\" [.8 .8 .8]", "\"mirror\" \"rgb Kr\" [.8 .8 .8]"}) {
        const auto scene =
            MakeScene(std::string("AreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\nMaterial ") +
                          material + "\nReverseOrientation\nShape \"sphere\" \"float radius\" [2]",
                      8, "0.3 0.2 -1  0 0 0  0 1 0", 1000);
        LearningRender render(*scene, RenderFor(64));
        render.Run();
        const Estimate e = Measure(*scene, SamplesOf(*scene, render.TheGuide()), 400, 3);
        EXPECT_NEAR(e.mean, 5, 4.5 * e.error + 1e-3) << material;
        EXPECT_NEAR(render.Mean(), 5, 4.5 * e.error * std::sqrt(400. / 64) + 1e-3) << material;
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
    LearningRender render(*scene, RenderFor(32));
    render.Run();
    EXPECT_EQ(render.film.RejectedCount(), 0);
    const Estimate e = Measure(*scene, SamplesOf(*scene, render.TheGuide()), 20, 2);
    EXPECT_EQ(e.rejected, 0);
    EXPECT_TRUE(std::isfinite(e.mean) && std::isfinite(e.variance));
}

TEST(Learning, KeepsToItsMemory) {
    const auto scene = MakeScene(kRoom, 64);
    for (const int spp : {40, 140}) {
        LearningRender render(*scene, RenderFor(spp), {.megabytes = 2});
        render.Run();
        EXPECT_LE(render.learner.Save().size(), (1u << 20) + 1000);
        EXPECT_TRUE(render.learner.Figures().isUsed);
    }
}

// Learning ends, and the guide stays what it is.
TEST(Learning, Ends) {
    const auto scene = MakeScene(kRoom, 8);
    LearningRender render(*scene, RenderFor(700));
    render.Run();
    EXPECT_TRUE(render.learner.IsDone());
    EXPECT_EQ(render.learner.Figures().samples, 508);
    EXPECT_EQ(render.learner.Records().directions, nullptr);
    LearningRender brief(*scene, RenderFor(700), {.isShort = true});
    brief.Run();
    EXPECT_TRUE(brief.learner.IsDone());
    EXPECT_EQ(brief.learner.Figures().samples, 60);
}

TEST(Learning, AutoGuidesWhereThatPays) {
    // Nothing but sky above a floor: light sampling finds all there is.
    const auto floor = MakeScene(
        "LightSource \"infinite\" \"rgb L\" [1 1 1]\nMaterial \"matte\"\n"
        "Shape \"disk\" \"float radius\" [10]",
        64, "0 0 2  0.1 0 0  0 0 1");
    LearningRender plain(*floor, RenderFor(320), {.mode = GuideMode::Auto});
    plain.Run();
    EXPECT_TRUE(plain.learner.IsDone());
    EXPECT_FALSE(plain.learner.Figures().isUsed);
    EXPECT_EQ(plain.learner.Figures().rounds, 3);
    EXPECT_EQ(plain.learner.Paths().guide, nullptr);
    EXPECT_EQ(plain.learner.Variance(plain.film, RegionOf(*floor)), 1);

    const auto room = MakeScene(kRoom, 64);
    LearningRender guided(*room, RenderFor(320), {.mode = GuideMode::Auto});
    guided.Run();
    const GuideComparison c = guided.learner.Figures().comparison;
    EXPECT_TRUE(guided.learner.Figures().isUsed) << c.variance;
    EXPECT_LT(c.variance + 2 * c.error, 0.9);
    EXPECT_NEAR(c.vertices, 1, 0.2);
    const double variance = guided.learner.Variance(guided.film, RegionOf(*room));
    EXPECT_LT(variance, 0.95);
    EXPECT_GT(variance, c.variance / 2);

    // What stops early is what it is without.
    LearningRender few(*room, RenderFor(200), {.mode = GuideMode::Auto});
    few.Run();
    EXPECT_FALSE(few.learner.Figures().isUsed);
    EXPECT_EQ(few.learner.Figures().samples, 0);
    Film without(RegionOf(*room), {.grid = GridOf(few.options.schedule)});
    Render({.source = SamplesOf(*room, Estimator::Combined), .film = &without}, RenderFor(200));
    EXPECT_TRUE(SamePixels(few.film, without));
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
    LearningRender render(*dark, RenderFor(40));
    render.Run();
    EXPECT_FALSE(render.learner.Figures().isUsed);
    EXPECT_FALSE(render.learner.Figures().why.empty());
}

}  // namespace
}  // namespace lull
