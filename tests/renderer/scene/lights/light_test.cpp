// Compares what sampling lights finds with what rays in random directions find.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/base/math.h"
#include "renderer/scene/lights/light_distribution.h"
#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/renderer/scene/lights/light_scene.h"
#include "tests/renderer/scene_of.h"

namespace lull {
namespace {

using test::Random;

// Returns the light that arrives at `from` along w, and the density with which sampling the light
// that it comes from finds w.
std::pair<Rgb, float> Arriving(const Scene& scene, const Vec3f& from, const Vec3f& w) {
    const Ray ray{.o = from, .d = w};
    Hit hit;
    if (!scene.accelerator.Intersect(ray, &hit)) {
        if (scene.lights.Infinite().empty()) return {Rgb::Zero(), 0};
        const Emitted found = LeAndPdf(scene.lights[scene.lights.Infinite()[0]], Vec3f::Zero(), w);
        return {found.L, found.pdf};
    }
    const int index = scene.shapes.LightAt(hit);
    if (index < 0) return {Rgb::Zero(), 0};
    SurfaceInteraction at;
    scene.shapes.Interact(ray, hit, kNeedsNothing, &at);
    const auto& light = std::get<AreaLight>(scene.lights[index]);
    return {light.Le(at.n, -w), light.Pdf(from, at.p, at.n)};
}

constexpr const char* kPlaced =
    "AttributeBegin\nTranslate .3 .2 2\nRotate 50 1 2 3\nScale 1.2 1.2 1.2\n"
    "AreaLightSource \"diffuse\" \"rgb L\" [3 2 1] \"bool twosided\" \"{}\"\n{}\nAttributeEnd\n";

TEST(Lights, SamplingFindsWhatRaysFind) {
    const std::string mesh =
        "Shape \"trianglemesh\" \"integer indices\" [0 2 1 0 3 2] "
        "\"point P\" [-1 -1 0  1 -1 0  1.5 1 .5  -1 1 .2]";
    const std::pair<const char*, std::string> worlds[] = {
        {"triangles", fmt::format(kPlaced, "false", mesh)},
        {"two-sided triangles", fmt::format(kPlaced, "true", mesh)},
        {"sphere", fmt::format(kPlaced, "false", "Shape \"sphere\" \"float radius\" [.7]")},
        {"sphere under a matrix of three digits",
         "AttributeBegin\nConcatTransform [.707 .707 0 0 -.707 .707 0 0 0 0 -1 0 .3 .2 2 1]\n"
         "AreaLightSource \"diffuse\" \"bool twosided\" \"true\"\nShape \"sphere\"\nAttributeEnd"},
        {"part of a sphere",
         fmt::format(kPlaced, "false",
                     "Shape \"sphere\" \"float radius\" [.7] \"float zmax\" [.5] "
                     "\"float phimax\" [300]")},
        {"triangles of which an alpha cuts half out",
         "Texture \"squares\" \"float\" \"checkerboard\" \"float uscale\" 4 "
         "\"float vscale\" 4\n" +
             fmt::format(kPlaced, "false",
                         mesh + " \"float uv\" [0 0 1 0 1 1 0 1] \"texture alpha\" "
                                "\"squares\"")},
        {"disk", fmt::format(kPlaced, "true", "Shape \"disk\" \"float radius\" [.7]")},
        {"cylinder", fmt::format(kPlaced, "false", "Shape \"cylinder\" \"float radius\" [.3]")},
        {"spot with a radius",
         "AttributeBegin\nTranslate .3 .2 2\nAreaLightSource \"spot-squared\" "
         "\"point to\" [.2 .3 -1] \"float coneangle\" [80] \"float conedeltaangle\" [60]\n"
         "Shape \"sphere\" \"float radius\" [.7]\nAttributeEnd"},
        {"triangles with a spread",
         "AttributeBegin\nTranslate .3 .2 2\nRotate 10 1 .2 0\nAreaLightSource \"diffuse\" "
         "\"float spread\" [150]\n" +
             mesh + "\nAttributeEnd"},
        {"infinite", "LightSource \"infinite\" \"rgb L\" [1 2 3]"},
        {"sun", "LightSource \"distant\" \"point from\" [1 2 -3] \"float angle\" [70]"},
        {"infinite, stretched", "Rotate 40 1 1 0\nScale 1 3 -.5\nLightSource \"infinite\""},
        {"image, stretched",
         "Scale 1 .4 1.5\nLightSource \"infinite\" \"string mapname\" \"sky.exr\""},
        {"image", "Rotate 40 1 1 0\nLightSource \"infinite\" \"string mapname\" \"sky.exr\""},
    };
    for (const auto& [name, world] : worlds) {
        const LightScene test(world);
        const Scene& scene = *test.scene;
        Random random(3);
        for (const Vec3f& from : {Vec3f(0, 0, 0), Vec3f(0.2f, -0.4f, 0.9f), Vec3f(2, 5, -4)}) {
            // The weight lets no direction be like another.
            const auto weight = [](const Vec3f& w) { return 1 + 0.5 * w.z() + 0.3 * w.x(); };
            test::SampleMean sampled, found;
            for (int k = 0; k < 40000; ++k) {
                double sum = 0;
                for (int i = 0; i < scene.lights.Count(); ++i) {
                    const auto s = scene.lights.Sample(i, from, random.Point());
                    if (!s) continue;
                    ASSERT_TRUE(s->pdf > 0 && std::isfinite(s->pdf)) << name;
                    ASSERT_NEAR(s->wi.norm(), 1, 1e-5) << name;
                    const bool isSeen = Arriving(scene, from, s->wi).first.sum() > 0;
                    sum += scene.lights.Radiance(i, *s).sum() * weight(s->wi) / s->pdf * isSeen;
                }
                sampled.Add(sum);
                const Vec3f w = SampleUniformSphere(random.Point());
                found.Add(4 * std::numbers::pi * Arriving(scene, from, w).first.sum() * weight(w));
            }
            EXPECT_GT(sampled.Value(), 0) << name;
            EXPECT_NEAR(sampled.Value(), found.Value(),
                        4.5 * std::hypot(sampled.Error(), found.Error()) + 1e-4 * found.Value())
                << name << " from " << from.transpose();
        }
    }
}

// pbrt-v4's portals guide sampling alone.
TEST(Lights, PortalsAreNoted) {
    for (const char* kind : {"", "\"bool studio\" \"true\""}) {
        Warnings warnings;
        const auto scene =
            SceneOf(WorldText(std::string("LightSource \"infinite\" ") + kind +
                              " \"point3 portal\" [0 0 0  1 0 0  1 1 0  0 1 0]\nShape \"sphere\""),
                    {}, &warnings);
        EXPECT_EQ(scene->lights.Count(), 1);
        auto counts = warnings.Counts();
        EXPECT_EQ(counts["portals are not used"], 1);
        EXPECT_EQ(counts["unused parameter"], 0);
    }
}

// Both sides of the power heuristic must speak of the same density.
TEST(Lights, SamplesKnowTheDensityThatRaysCompute) {
    for (const char* shape :
         {"Shape \"trianglemesh\" \"integer indices\" [0 1 2] "
          "\"point P\" [-1 -1 0  1 -1 0  1.5 1 .5]",
          "Shape \"sphere\" \"float radius\" [.7]", "Shape \"disk\" \"float radius\" [.7]"}) {
        const LightScene test(fmt::format(kPlaced, "true", shape));
        Random random(4);
        int different = 0;
        for (int k = 0; k < 10000; ++k) {
            const Vec3f from = 3 * SampleUniformSphere(random.Point());
            const auto s = test.scene->lights.Sample(0, from, random.Point());
            if (!s) continue;
            const float pdf = Arriving(*test.scene, from, s->wi).second;
            different += !(std::abs(pdf - s->pdf) <= 2e-3f * s->pdf);
        }
        // Grazing rays meet the light elsewhere.
        EXPECT_LT(different, 100) << shape;
    }
}

TEST(Lights, RefuseToBeStretched) {
    for (const char* shape : {"sphere", "disk"}) {
        const std::string error = ErrorOf([&] {
            LightScene(
                fmt::format("AttributeBegin\nScale 1 2 1\nAreaLightSource \"diffuse\"\n"
                            "Shape \"{0}\"\nAttributeEnd\nShape \"{0}\"",
                            shape));
        });
        EXPECT_HAS(error, "test.pbrt:6: a light of shape");
    }
}

TEST(Lights, WithoutAreaGiveWhatTheirFormulasSay) {
    const Vec3f from(0, 0, 0);
    const auto sampleOf = [&](const std::string& world) {
        const LightScene test(world);
        return test.scene->lights.Sample(0, from, {0.5f, 0.5f});
    };
    // Radiant intensity over squared distance.
    auto s = sampleOf("LightSource \"point\" \"rgb I\" [8 4 2] \"point from\" [0 0 2]");
    ASSERT_TRUE(s && s->isDelta);
    EXPECT_NEAR(s->L.x(), 2, 1e-5);
    EXPECT_NEAR(s->wi.z(), 1, 1e-6);
    s = sampleOf(
        "LightSource \"distant\" \"rgb L\" [8 4 2] \"point from\" [0 3 4] "
        "\"point to\" [0 0 0]");
    ASSERT_TRUE(s && s->isDelta);
    EXPECT_NEAR(s->L.y(), 4, 1e-5);
    EXPECT_NEAR(s->wi.y(), 0.6f, 1e-6);
    // Within the cone, in its soft border (pbrt 3rd ed., 12.3.2) and beyond.
    const std::string spot =
        "LightSource \"spot\" \"rgb I\" [4 4 4] \"float coneangle\" [30] "
        "\"float conedeltaangle\" [10] \"point from\" [0 0 2] \"point to\" [{} 0 0]";
    s = sampleOf(fmt::format(fmt::runtime(spot), 0));
    ASSERT_TRUE(s);
    EXPECT_NEAR(s->L.x(), 1, 1e-5);
    const double degree = std::numbers::pi / 180;
    s = sampleOf(fmt::format(fmt::runtime(spot), 2 * std::tan(25 * degree)));
    ASSERT_TRUE(s);
    const double delta = (std::cos(25 * degree) - std::cos(30 * degree)) /
                         (std::cos(20 * degree) - std::cos(30 * degree));
    EXPECT_NEAR(s->L.x(), std::pow(delta, 4), 1e-4);
    s = sampleOf(fmt::format(fmt::runtime(spot), 2 * std::tan(31 * degree)));
    EXPECT_TRUE(!s || s->L.isZero());
}

// As pbrt-v3 counts samples of negative luminance; here no pixel is negative either.
TEST(Lights, CountNegativePartsAsBlack) {
    for (const std::string light :
         {"LightSource \"point\" \"rgb I\"", "LightSource \"spot\" \"rgb I\"",
          "LightSource \"distant\" \"rgb L\"", "LightSource \"infinite\" \"rgb L\"",
          "LightSource \"goniometric\" \"rgb I\"", "LightSource \"projection\" \"rgb I\"",
          "AreaLightSource \"area\" \"rgb L\""}) {
        Warnings warnings;
        const auto scene =
            SceneOf(WorldText(light + " [16 -0.5 12]\nShape \"sphere\"", "Camera \"perspective\""),
                    {}, &warnings);
        const Rgb power = std::visit([](const auto& l) { return l.Power(); }, scene->lights[0]);
        EXPECT_EQ(power.y(), 0) << light;
        EXPECT_GT(power.x(), power.z()) << light;
        EXPECT_EQ(
            warnings.Counts(),
            (std::map<std::string, int>{{"a light has a negative part, which counts as black", 1}}))
            << light;
    }
}

// They are pbrt-v3's, whose two sides disagree.
TEST(AreaLights, WarnOfMirroredQuadrics) {
    const auto countOf = [](const std::string& text) {
        return WarningsOf(WorldText("AreaLightSource \"diffuse\" " + text)).size();
    };
    for (const char* shape : {"sphere", "disk", "cylinder"}) {
        const std::string rest = fmt::format("\nShape \"{}\"", shape);
        EXPECT_EQ(countOf("Scale -1 1 1" + rest), 1u) << shape;
        EXPECT_EQ(countOf("Scale -1 -1 1" + rest), 0u) << shape;
        EXPECT_EQ(countOf("\"bool twosided\" \"true\" Scale -1 1 1" + rest), 0u) << shape;
    }
}

// A part that compression left below 0 costs a texel nothing else.
TEST(Skies, LoseWhatIsNegativeOrNotFiniteAlone) {
    const TemporaryDirectory directory;
    ExrImage sky;
    sky.width = 4;
    sky.height = 1;
    sky.channels = {{"R", {.5f, .5f, NAN, .5f}, false},
                    {"G", {.25f, .25f, .25f, .25f}, false},
                    {"B", {-1e-7f, -1, 1, 1}, false}};
    WriteExr(directory.File("sky.exr"), sky);
    Warnings warnings;
    const auto scene =
        SceneIn(directory.Write("test.pbrt",
                                "Camera \"perspective\"\nWorldBegin\nLightSource \"infinite\" "
                                "\"string mapname\" \"sky.exr\"\nShape \"sphere\"\nWorldEnd\n"),
                {}, &warnings);
    const Rgb expected[] = {{.5f, .25f, 0}, {.5f, .25f, 0}, {0, 0, 0}, {.5f, .25f, 1}};
    for (int i = 0; i < 4; ++i) {
        const float phi = (float(i) + .5f) * kPi / 2;
        const Rgb L =
            LeAndPdf(scene->lights[0], Vec3f::Zero(), Vec3f(std::cos(phi), std::sin(phi), 0)).L;
        EXPECT_LT((L - expected[i]).abs().maxCoeff(), 1e-3f) << i;
    }
    EXPECT_EQ(warnings.Counts().at("environment map texel that is not finite or negative"), 2);
}

// In pbrt-v3 they are balls of air in glass.
TEST(Shapes, WarnOfMirroredQuadricsOfGlass) {
    const auto isWarnedOf = [](const std::string& text) {
        for (const auto& [kind, count] : WarningsOf(WorldText(text + "\nShape \"sphere\"")))
            if (Contains(kind, "inside out")) return true;
        return false;
    };
    const std::string mirror = "Scale 1 -1 1 ";
    EXPECT_TRUE(isWarnedOf(mirror + "Material \"glass\""));
    EXPECT_FALSE(isWarnedOf(mirror + "Material \"glass\" ReverseOrientation"));
    EXPECT_FALSE(isWarnedOf(mirror + "Material \"mirror\""));
    EXPECT_FALSE(isWarnedOf("Material \"glass\""));
}

TEST(LightProbes, KnowWhatSamplesBring) {
    const std::string emitting = "AreaLightSource \"diffuse\" \"rgb L\" [3 2 1] ";
    const std::string twoSided = emitting + "\"bool twosided\" \"true\" ";
    const std::string triangle =
        "Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point P\" [-1 -1 0  1 -1 0  0 1 .5]";
    const std::string sphere = "Shape \"sphere\" \"float radius\" [.7]";
    const std::string worlds[] = {
        emitting + triangle,
        twoSided + triangle,
        emitting + sphere,
        emitting + "ReverseOrientation " + sphere,
        twoSided + "ReverseOrientation " + sphere,
        emitting + "Shape \"disk\" \"float radius\" [.7]",
        "LightSource \"point\" \"rgb I\" [1 2 3]",
        "LightSource \"infinite\" \"rgb L\" [1 2 3]",
    };
    const LightProbes probes;
    for (const std::string& world : worlds) {
        const auto scene =
            SceneOf(WorldText("AttributeBegin\nScale 2 2 2\n" + world + "\nAttributeEnd\n"));
        ASSERT_EQ(scene->lights.Count(), 1) << world;
        // Before and behind it, around it, and where it lies in the voxel.
        for (const Bounds3f& voxel :
             {Bounds3f{{2, 1, 3}, {3, 2, 5}}, Bounds3f{{-2, 1, -5}, {0, 2, -3}},
              Bounds3f{{-.2f, -.2f, -.2f}, {.2f, .2f, .2f}}, Bounds3f{{-3, -3, -3}, {3, 3, 3}}}) {
            const LightProbes::Places places = probes.PlacesIn(voxel);
            double expected = 0;
            for (int k = 0; k < LightProbes::kCount; ++k) {
                const Vec3f p(places(k, 0), places(k, 1), places(k, 2));
                if (const auto sample = scene->lights.Sample(0, p, probes.u[size_t(k)]))
                    expected += Luminance(scene->lights.Radiance(0, *sample)) / sample->pdf;
            }
            EXPECT_NEAR(Contribution(scene->lights[0], probes, places), expected, 2e-4 * expected)
                << world << voxel.lower.transpose();
        }
    }
}

}  // namespace

}  // namespace lull
