#include "renderer/transport/integrator.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/renderer/scene_of.h"

namespace lull {

// Compares the first hits of paths with the scene.
namespace {

constexpr Estimator kBoth[] = {Estimator::Combined, Estimator::PbrtV3};

// An image of one pixel with a box filter, whose camera at z = -3 looks at the origin.
std::unique_ptr<const Scene> MakeScene(const std::string& world, const std::string& before = "",
                                       const std::string& camera = "") {
    return SceneOf(
        WorldText(world,
                  "LookAt 0 0 -3  0 0 0  0 1 0\n"
                  "Film \"image\" \"integer xresolution\" [1] \"integer yresolution\" [1]\n" +
                      before + "\nCamera \"perspective\" \"float fov\" [20] " + camera));
}

constexpr const char* kSky = "LightSource \"infinite\" \"rgb L\" [.25 .5 4]\n";
// Squares across the view at a given z, facing the camera.
std::string Wall(double z, double size = 10) {
    return fmt::format(
        "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" "
        "[-{1} -{1} {0}  -{1} {1} {0}  {1} {1} {0}  {1} -{1} {0}]\n",
        z, size);
}

FirstHit Find(const Scene& scene, Estimator estimator, bool throughSpecular = false,
              uint32_t index = 0) {
    Sampler sampler(SamplerKind::Random, 7);
    PathSample sample{.asksForHit = true};
    PathOptions options = estimator;
    options.throughSpecular = throughSpecular;
    RenderSample(scene, options, sampler, {0, 0}, index, &sample);
    return sample.hit;
}

void ExpectColor(const Rgb& color, const Rgb& expected, float slack = 1e-5f) {
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(color[c], expected[c], slack);
}

TEST(FirstHit, IsWhatIsSeen) {
    for (const Estimator estimator : kBoth) {
        const auto scene = MakeScene(
            "Material \"matte\"\nShape \"sphere\" \"float radius\" [.01]\n"
            "Material \"matte\" \"rgb Kd\" [.1 .6 .9]\n" +
            Wall(2));
        for (uint32_t k = 0; k < 16; ++k) {
            const FirstHit hit = Find(*scene, estimator, false, k);
            ASSERT_TRUE(hit.found);
            ExpectColor(hit.albedo, {0.1f, 0.6f, 0.9f});
            EXPECT_NEAR(hit.depth, 5, 1e-4f);  // from the camera's plane, all over the wall
            EXPECT_NEAR(hit.position.z(), 2, 1e-4f);
            EXPECT_NEAR(hit.normal.z(), -1, 1e-5f);
            EXPECT_EQ(hit.object, 2u);
            EXPECT_EQ(hit.weight, 1);
            EXPECT_LE(hit.offset2, 0.5f);
        }
    }
}

// What is nearer than that is not seen, and the depth is still that from the camera.
TEST(FirstHit, IsBeyondWhereCamerasBeginToSee) {
    const auto scene = MakeScene(Wall(0) + Wall(2), "", "\"float clipstart\" [4]");
    const FirstHit hit = Find(*scene, Estimator::Combined);
    ASSERT_TRUE(hit.found);
    EXPECT_NEAR(hit.depth, 5, 1e-4f);
    EXPECT_NEAR(hit.position.z(), 2, 1e-4f);
}

TEST(FirstHit, KnowsTheLampSeenDirectly) {
    const std::string lamp =
        "AttributeBegin\nAreaLightSource \"area\" \"rgb L\" [4 5 6]\n"
        "Material \"matte\" \"rgb Kd\" [0 0 0]\n" +
        Wall(2) + "AttributeEnd\n";
    for (const Estimator estimator : kBoth) {
        const auto scene = MakeScene(lamp);
        Sampler sampler(SamplerKind::Random, 7);
        PathSample sample{.asksForFeatures = true};
        RenderSample(*scene, estimator, sampler, {0, 0}, 0, &sample);
        EXPECT_FALSE(IsBlack(sample.features.emission));
        ExpectColor(sample.features.emission, sample.radiance);
    }
    // Seen in a mirror it is like any light that is reflected; the sky is no lamp.
    const auto mirror =
        MakeScene("Material \"mirror\"\nRotate 45 0 1 0\n" + Wall(0) + "Rotate -45 0 1 0\n" + kSky);
    EXPECT_TRUE(IsBlack(Find(*mirror, Estimator::Combined, true).emission));
    EXPECT_TRUE(IsBlack(Find(*MakeScene(kSky), Estimator::Combined).emission));
}

TEST(FirstHit, NumbersInstancesAfterShapes) {
    const auto scene = MakeScene("ObjectBegin \"o\"\n" + Wall(0) + "ObjectEnd\n" + Wall(9) +
                                 "Translate 0 0 20\nObjectInstance \"o\"\nTranslate 0 0 -19\n"
                                 "Material \"mirror\"\nObjectInstance \"o\"\n");
    const FirstHit hit = Find(*scene, Estimator::Combined);
    EXPECT_NEAR(hit.depth, 4, 1e-4f);
    EXPECT_EQ(hit.object, 3u);  // the wall of the world, then two instances
}

TEST(FirstHit, IsOnTheSideOfTheViewer) {
    const auto scene =
        MakeScene("ReverseOrientation\n" + Wall(2) + "Shape \"sphere\" \"float radius\" [5]");
    EXPECT_NEAR(Find(*scene, Estimator::Combined).normal.z(), -1, 1e-5f);
    const auto inside = MakeScene("Shape \"sphere\" \"float radius\" [5]");
    EXPECT_LT(Find(*inside, Estimator::Combined).normal.z(), -0.95f);
}

TEST(FirstHit, IsLightWhereLightIsSeen) {
    for (const Estimator estimator : kBoth) {
        const FirstHit sky = Find(*MakeScene(kSky), estimator);
        EXPECT_FALSE(sky.found);
        ExpectColor(sky.albedo, {0.25f, 0.5f, 1});
        EXPECT_EQ(sky.object, 0u);
        const auto lamp = MakeScene(
            "Material \"matte\" \"rgb Kd\" [.5 .5 .5]\n"
            "AreaLightSource \"diffuse\" \"rgb L\" [.75 20 0] \"bool twosided\" \"true\"\n" +
            Wall(1));
        const FirstHit hit = Find(*lamp, estimator);
        EXPECT_TRUE(hit.found);
        ExpectColor(hit.albedo, {0.75f, 1, 0.5f});
        const FirstHit exposed =
            Find(*MakeScene(kSky,
                            "Film \"image\" \"integer xresolution\" [1] \"integer yresolution\" "
                            "[1] \"float scale\" [.5]"),
                 estimator);
        ExpectColor(exposed.albedo, {0.125f, 0.25f, 1});
    }
}

// A red mirror faces the camera, and a green wall is behind the camera.
TEST(FirstHit, GoesThroughMirrorsWhereAsked) {
    const auto scene = MakeScene("Material \"mirror\" \"rgb Kr\" [.8 .4 .2]\n" + Wall(1, 3) +
                                 "Material \"matte\" \"rgb Kd\" [.5 1 .5]\n" + Wall(-10, 60));
    for (const Estimator estimator : kBoth) {
        const FirstHit mirror = Find(*scene, estimator);
        ExpectColor(mirror.albedo, {0.8f, 0.4f, 0.2f});
        EXPECT_NEAR(mirror.depth, 4, 1e-4f);
        EXPECT_EQ(mirror.object, 1u);
        const FirstHit through = Find(*scene, estimator, true);
        ExpectColor(through.albedo, {0.4f, 0.4f, 0.1f});
        EXPECT_NEAR(through.depth, 4 + 11, 1e-3f);  // where it seems to be
        EXPECT_NEAR(through.position.z(), -10, 1e-4f);
        EXPECT_NEAR(through.normal.z(), 1, 1e-5f);
        EXPECT_EQ(through.object, 2u);
    }
}

TEST(FirstHit, GlassIsWhiteAndClear) {
    const auto scene = MakeScene(
        "Material \"glass\"\nShape \"sphere\" \"float radius\" [1]\n"
        "Material \"matte\" \"rgb Kd\" [.1 .2 .3]\n" +
        Wall(4, 500) + Wall(-400, 500));
    for (const Estimator estimator : kBoth) {
        ExpectColor(Find(*scene, estimator).albedo, Rgb::Ones());
        int found = 0;
        for (uint32_t k = 0; k < 64; ++k) {
            const FirstHit hit = Find(*scene, estimator, true, k);
            if (!hit.found) continue;  // reflected inside until the path ended
            ++found;
            EXPECT_EQ(hit.object >= 2, true);
            ExpectColor(hit.albedo, {0.1f, 0.2f, 0.3f}, 1e-4f);
        }
        EXPECT_GE(found, 62);
    }
}

TEST(FirstHit, OfAPathAtItsEndIsWhatIsSeenAllTheSame) {
    const auto scene = MakeScene(Wall(2), "Integrator \"path\" \"integer maxdepth\" [0]");
    for (const Estimator estimator : kBoth) {
        const FirstHit hit = Find(*scene, estimator);
        EXPECT_TRUE(hit.found);
        ExpectColor(hit.albedo, {0.5f, 0.5f, 0.5f});
    }
}

TEST(FirstHit, CanBeAPointInAMedium) {
    const std::string ball =
        "MakeNamedMedium \"m\" \"string type\" \"homogeneous\" \"rgb sigma_a\" [{0} {0} {0}]"
        " \"rgb sigma_s\" [{1} {1} {1}]\nMaterial \"none\"\nMediumInterface \"m\" \"\"\n"
        "Shape \"sphere\"\nMediumInterface \"\" \"\"\nMaterial \"matte\"\n" +
        Wall(2);
    const std::string before = "Integrator \"volpath\"";
    for (const Estimator estimator : kBoth) {
        const FirstHit fog =
            Find(*MakeScene(fmt::format(fmt::runtime(ball), 5000, 15000), before), estimator);
        EXPECT_TRUE(fog.found);
        EXPECT_NEAR(fog.depth, 2, 0.05f);
        EXPECT_EQ(fog.object, 0u);
        EXPECT_TRUE(fog.normal.isZero());
        ExpectColor(fog.albedo, Rgb::Constant(0.75f));
        const FirstHit wall =
            Find(*MakeScene(fmt::format(fmt::runtime(ball), 0, 1e-6), before), estimator);
        EXPECT_NEAR(wall.depth, 5, 1e-3f);
        EXPECT_EQ(wall.object, 2u);
    }
}

// The denoiser sees through glass, whatever AOVs show.
TEST(FirstHit, IsOneThingAndFeaturesAreAnother) {
    const auto scene = MakeScene("Material \"glass\"\n" + Wall(0) +
                                 "Material \"matte\" \"rgb Kd\" [.1 .6 .9]\n" + Wall(2) + kSky);
    Sampler sampler(SamplerKind::Random, 7);
    PathOptions options = Estimator::Combined;
    int behind = 0;
    for (uint32_t k = 0; k < 16; ++k)
        for (const bool throughSpecular : {false, true}) {
            options.throughSpecular = throughSpecular;
            PathSample both{.asksForHit = true, .asksForFeatures = true},
                alone{.asksForFeatures = true};
            RenderSample(*scene, options, sampler, {0, 0}, k, &both);
            RenderSample(*scene, options, sampler, {0, 0}, k, &alone);
            ExpectColor(both.features.albedo, alone.features.albedo, 0);
            EXPECT_EQ(both.features.depth, alone.features.depth);
            EXPECT_EQ(both.hit.object, throughSpecular ? both.features.object : 1);
            EXPECT_EQ(both.hit.offset2, both.features.offset2);
            behind += both.features.object == 2;
        }
    EXPECT_GT(behind, 16);  // the others are reflected
}

TEST(FirstHit, EnvironmentCamerasMeasureDistance) {
    const auto scene =
        SceneOf(WorldText("Shape \"sphere\" \"float radius\" [7]",
                          "Film \"image\" \"integer xresolution\" [4] \"integer yresolution\" [4]\n"
                          "Camera \"environment\""));
    for (int i = 0; i < 16; ++i) {
        Sampler sampler(SamplerKind::Random, 7);
        PathSample sample{.asksForHit = true};
        RenderSample(*scene, Estimator::Combined, sampler, {i % 4, i / 4}, 0, &sample);
        EXPECT_NEAR(sample.hit.depth, 7, 1e-3f);
    }
}

// Asking for layers changes no sample.
TEST(FirstHit, LeavesTheImageAsItIs) {
    const std::string world =
        std::string(kSky) +
        "LightSource \"point\" \"point from\" [1 1 -2]\nMaterial \"plastic\"\n" + Wall(1) +
        "Material \"glass\"\nShape \"sphere\" \"float radius\" [.4]\n"
        "Material \"metal\" \"float roughness\" [.1]\nTranslate 0 -.6 0\nShape \"sphere\" \"float "
        "radius\" [.3]\n";
    for (const char* integrator : {"Integrator \"path\"", "Integrator \"volpath\""})
        for (const Estimator estimator : kBoth) {
            const auto scene = MakeScene(world, integrator);
            for (uint32_t k = 0; k < 500; ++k) {
                Sampler a(SamplerKind::Sobol, 3), b(SamplerKind::Sobol, 3);
                PathOptions options = estimator;
                options.throughSpecular = true;
                PathSample with{.asksForHit = true, .asksForFeatures = true};
                RenderSample(*scene, options, a, {0, 0}, k, &with);
                const PathSample without = RenderSample(*scene, estimator, b, {0, 0}, k);
                for (int c = 0; c < 3; ++c) ASSERT_EQ(with.radiance[c], without.radiance[c]);
            }
        }
}

}  // namespace
}  // namespace lull

namespace lull::path_log_test {

// Compares the paths that are told about with those that are rendered.
namespace {

constexpr const char* kGlass =
    "Integrator \"path\" \"integer maxdepth\" [7]\nCamera \"perspective\" \"float fov\" [40]\n"
    "WorldBegin\nLightSource \"infinite\" \"rgb L\" [.2 .3 .4]\n"
    "AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [9 8 7] Translate 0 2.5 0\n"
    "Shape \"sphere\" \"float radius\" [.4] AttributeEnd\n"
    "Material \"glass\" Shape \"sphere\" \"float radius\" [.7]\n"
    "Material \"matte\" Translate 0 -1 0 Rotate 90 1 0 0 Shape \"disk\" \"float radius\" [9]\n"
    "WorldEnd\n";
constexpr const char* kFog =
    "Integrator \"volpath\" \"integer maxdepth\" [9]\n"
    "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"rgb sigma_s\" [.5 .5 .5]\n"
    "Camera \"perspective\" \"float fov\" [40]\nWorldBegin\n"
    "LightSource \"point\" \"rgb I\" [5 5 5] \"point from\" [0 3 0]\n"
    "AttributeBegin Material \"\" MediumInterface \"fog\" \"\"\n"
    "Shape \"sphere\" \"float radius\" [1.5] AttributeEnd\n"
    "Material \"matte\" Shape \"sphere\" \"float radius\" [.5]\nWorldEnd\n";

std::unique_ptr<const Scene> MakeScene(const std::string& text) {
    return SceneOf(
        "LookAt 0 0 -5  0 0 0  0 1 0\n"
        "Film \"image\" \"integer xresolution\" [8] \"integer yresolution\" [8]\n" +
        text);
}

TEST(PathLog, IsOfTheSampleThatIsRendered) {
    for (const char* text : {kGlass, kFog})
        for (const Estimator estimator : {Estimator::Combined, Estimator::PbrtV3}) {
            const auto scene = MakeScene(text);
            Sampler sampler(SamplerKind::Sobol, 3);
            size_t steps = 0;
            for (int i = 0; i < 640; ++i) {
                const Vec2i pixel(i % 8, i / 8 % 8);
                const auto index = uint32_t(i / 64);
                const PathSample rendered = RenderSample(*scene, estimator, sampler, pixel, index);
                const PathLog log = LogSample(*scene, estimator, sampler, pixel, index);
                ASSERT_TRUE((log.sample.radiance == rendered.radiance).all()) << i;
                // The steps add up to it, and each starts where the one before ended.
                Rgb sum = Rgb::Zero();
                Vec3f from = log.ray.o, direction = log.ray.d.normalized();
                for (const PathStep& step : log.steps) {
                    sum += step.emitted + step.direct;
                    if (step.kind != PathStep::Kind::Sky) {
                        ASSERT_LT((from + step.distance * direction - step.position).norm(), 1e-2f);
                    }
                    from = step.position;
                    direction = step.direction;
                }
                sum *= log.filterWeight * log.cameraWeight * log.filmScale;
                ASSERT_LT((sum - rendered.radiance).abs().maxCoeff(),
                          1e-4f * (1 + rendered.radiance.maxCoeff()));
                steps += log.steps.size();
            }
            EXPECT_GT(steps, 640u);
        }
}

TEST(PathLog, TellsWhereLightComesFrom) {
    const auto scene = MakeScene(kGlass);
    Sampler sampler(SamplerKind::Random, 1);
    // The middle of the picture: into the glass ball and out of it, or off it.
    const PathLog log = LogSample(*scene, Estimator::Combined, sampler, {4, 4}, 0);
    ASSERT_GE(log.steps.size(), 2u);
    const PathStep& first = log.steps[0];
    EXPECT_EQ(first.kind, PathStep::Kind::Surface);
    EXPECT_EQ(first.object, 2u);
    EXPECT_NEAR(first.distance, 4.4f, 0.2f);  // not quite in the middle
    EXPECT_TRUE(first.goesOn);
    EXPECT_TRUE(first.isSpecular);
    EXPECT_TRUE(IsBlack(first.direct));
    EXPECT_TRUE((first.throughput == 1).all());
}

}  // namespace
}  // namespace lull::path_log_test
