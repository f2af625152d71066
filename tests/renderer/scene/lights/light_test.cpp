// Compares what sampling lights finds with what rays in random directions find.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/image/image_io.h"
#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/renderer/scene_of.h"

namespace lull {
namespace {

using test::Random;

struct LightScene {
    TemporaryDirectory directory;
    std::unique_ptr<const Scene> scene;

    explicit LightScene(const std::string& world) {
        ExrImage sky;
        sky.width = 8;
        sky.height = 4;
        for (const char* channel : {"R", "G", "B"}) {
            sky.channels.push_back({channel, {}, false});
            for (int i = 0; i < 32; ++i)
                sky.channels.back().values.push_back(float(i * 7 % 13) + (i == 13) * 90);
        }
        WriteExr(directory.File("sky.exr"), sky);
        Warnings warnings;
        // A scene without a shape is worth a warning.
        const std::string text = "Camera \"perspective\"\nWorldBegin\n" + world +
                                 "\nShape \"trianglemesh\" \"integer indices\" [0 1 2] "
                                 "\"point P\" [0 0 -50  .01 0 -50  0 .01 -50]\nWorldEnd\n";
        scene = SceneIn(directory.Write("test.pbrt", text), {}, &warnings);
        for (const auto& [kind, count] : warnings.Counts()) ADD_FAILURE() << kind;
    }
};

// Returns the light that arrives at `from` along w, and the density with which sampling the light
// that it comes from finds w.
std::pair<Rgb, float> Arriving(const Scene& scene, const Vec3f& from, const Vec3f& w) {
    const Ray ray{.o = from, .d = w};
    Hit hit;
    if (!scene.accelerator.Intersect(ray, &hit)) {
        if (scene.lights.Infinite().empty()) return {Rgb::Zero(), 0};
        const Emitted found = LeAndPdf(scene.lights[scene.lights.Infinite()[0]], w);
        return {found.L, found.pdf};
    }
    const int index = scene.shapes.LightAt(hit);
    if (index < 0) return {Rgb::Zero(), 0};
    SurfaceInteraction at;
    scene.shapes.Interact(ray, hit, kNeedsNothing, &at);
    const auto& light = std::get<AreaLight>(scene.lights[index]);
    return {light.Le(at.n, -w), light.Pdf(from, at.p, at.n)};
}

struct Mean {
    double sum = 0, squares = 0;
    int n = 0;

    void Add(double v) {
        sum += v;
        squares += v * v;
        ++n;
    }
    double Value() const { return sum / n; }
    double Variance() const { return (squares / n - Value() * Value()) / n; }
};

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
            Mean sampled, found;
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
            EXPECT_NEAR(
                sampled.Value(), found.Value(),
                4.5 * std::sqrt(sampled.Variance() + found.Variance()) + 1e-4 * found.Value())
                << name << " from " << from.transpose();
        }
    }
}

// From afar a small sphere shines as the spot light at its centre does.
TEST(Lights, SpotsWithARadiusShineAsSpots) {
    const std::string cone =
        "\"spot-squared\" \"point to\" [.2 .3 -1] \"float coneangle\" [50] "
        "\"float conedeltaangle\" [30] ";
    const std::string placed = "AttributeBegin\nRotate 40 1 2 3\nTranslate 1 2 3\n";
    const LightScene sharp(placed + "LightSource " + cone + "\"rgb I\" [3 2 1]\nAttributeEnd\n");
    const double area = std::numbers::pi * 1e-4;
    const LightScene soft(placed + "AreaLightSource " + cone +
                          fmt::format("\"rgb L\" [{} {} {}]\nShape \"sphere\" \"float radius\" "
                                      "[.01]\nAttributeEnd\n",
                                      3 / area, 2 / area, 1 / area));
    const LightTable &point = sharp.scene->lights, &sphere = soft.scene->lights;
    Random random(6);
    int lit = 0, dark = 0;
    for (int k = 0; k < 1000; ++k) {
        const Vec3f from = 20 * SampleUniformSphere(random.Point());
        const auto expected = point.Sample(0, from, random.Point());
        const auto s = sphere.Sample(0, from, random.Point());
        ++(expected ? lit : dark);
        if (!expected || expected->L.x() < 1e-3f * 3 / 400) continue;
        ASSERT_TRUE(s);
        const Rgb L = s->L / s->pdf;
        EXPECT_TRUE(L.isApprox(expected->L, 0.05f))
            << L.transpose() << " " << expected->L.transpose();
    }
    EXPECT_GT(lit, 100);
    EXPECT_GT(dark, 100);
    EXPECT_TRUE(sphere[0].index() != point[0].index());
}

// A mirror changes neither the width of a cone nor the side of a sphere that shines.
TEST(Lights, SpotsInMirroredCoordinatesShineWhereTheirImagesDo) {
    const std::string cone = "\"float coneangle\" [40] \"float conedeltaangle\" [20] ";
    for (const bool isSphere : {false, true})
        for (const Vec3f& s : {Vec3f(-1, 1, 1), Vec3f(1, 1, -1), Vec3f(-1, -1, -1)}) {
            const auto lightOf = [&](const Vec3f& scale, const Vec3f& to) {
                const std::string spot = fmt::format("\"spot-squared\" \"point to\" [{} {} {}] {}",
                                                     to.x(), to.y(), to.z(), cone);
                return fmt::format("Scale {} {} {}\n", scale.x(), scale.y(), scale.z()) +
                       (isSphere ? "AreaLightSource " + spot +
                                       "\"rgb L\" [3 2 1]\nShape \"sphere\" \"float radius\" [.01]"
                                 : "LightSource " + spot + "\"rgb I\" [3 2 1]");
            };
            const Vec3f to(0.2f, 0.3f, -1);
            const LightScene plain(lightOf(Vec3f::Ones(), to)),
                mirrored(lightOf(s, to.cwiseProduct(s)));
            Random random(6);
            int lit = 0;
            for (int k = 0; k < 300; ++k) {
                const Vec3f from = 5 * SampleUniformSphere(random.Point());
                const Vec2f u = random.Point();
                const auto arriving = [&](const LightScene& scene) -> double {
                    const auto light = scene.scene->lights.Sample(0, from, u);
                    return light ? double(light->L.x() / light->pdf) : 0;
                };
                const double peak = 3 * (isSphere ? std::numbers::pi * 1e-4 : 1) / 25;
                lit += arriving(plain) > 0.5 * peak;
                EXPECT_NEAR(arriving(mirrored), arriving(plain), 0.03 * peak)
                    << isSphere << " " << s.transpose();
            }
            EXPECT_GT(lit, 10);
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
    for (const char* shape : {"sphere", "disk"}) try {
            LightScene(
                fmt::format("AttributeBegin\nScale 1 2 1\nAreaLightSource \"diffuse\"\n"
                            "Shape \"{}\"\nAttributeEnd\nShape \"{}\"",
                            shape, shape));
            ADD_FAILURE() << shape;
        } catch (const Error& error) {
            EXPECT_TRUE(Contains(error.what(), "test.pbrt:6: a light of shape")) << error.what();
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

// Writes a 4x2 image whose texel (x, y) is x + 10 y in red, and 1 in green and blue.
std::string WriteBeam(const TemporaryDirectory& directory) {
    ExrImage image;
    image.width = 4;
    image.height = 2;
    for (const char* channel : {"R", "G", "B"}) {
        image.channels.push_back({channel, {}, false});
        for (int i = 0; i < 8; ++i)
            image.channels.back().values.push_back(channel[0] == 'R' ? float(i % 4 + 10 * (i / 4))
                                                                     : 1);
    }
    WriteExr(directory.File("beam.exr"), image);
    return directory.File("beam.exr");
}

LightSample SampleOf(const Scene& scene, const Vec3f& from) {
    const auto s = scene.lights.Sample(0, from, {0.5f, 0.5f});
    return s ? *s
             : LightSample{
                   .L = Rgb::Zero(), .wi = {}, .pdf = 0, .isDelta = true, .isHidden = false};
}

TEST(GoniometricLight, ShinesAsItsImageSays) {
    const TemporaryDirectory directory;
    const LightScene s(
        "Translate 1 2 3\nLightSource \"goniometric\" \"rgb I\" [2 4 6] "
        "\"string mapname\" \"" +
        WriteBeam(directory) + "\"");
    // The image's rows go from y = 1 down to -1, its columns from x towards z.
    const auto at = [&](const Vec3f& w) { return SampleOf(*s.scene, Vec3f(1, 2, 3) + 2 * w); };
    const auto towards = [](float theta, float phi) {
        return Vec3f(std::sin(theta) * std::cos(phi), std::cos(theta),
                     std::sin(theta) * std::sin(phi));
    };
    for (int x = 0; x < 4; ++x)
        for (int y = 0; y < 2; ++y) {
            const Vec3f w = towards((y + 0.5f) / 2 * kPi, (x + 0.5f) / 4 * 2 * kPi);
            const LightSample sample = at(w);
            EXPECT_NEAR(sample.L.x(), 2 * (x + 10 * y) / 4.f, 1e-4) << x << " " << y;
            EXPECT_NEAR(sample.L.z(), 6 / 4.f, 1e-4);
            EXPECT_NEAR((sample.wi + w).norm(), 0, 1e-5);
            EXPECT_TRUE(sample.isDelta);
        }
    const Rgb power = std::get<GoniometricLight>(s.scene->lights[0]).Power();
    EXPECT_NEAR(power.x(), 4 * kPi * 2 * 6.5f, 1e-3);

    const LightScene plain("LightSource \"goniometric\" \"rgb I\" [2 4 6]");
    EXPECT_NEAR(SampleOf(*plain.scene, Vec3f(0, 0, -2)).L.y(), 1, 1e-5);
}

TEST(ProjectionLight, ShowsItsImage) {
    const TemporaryDirectory directory;
    const LightScene s(
        "Translate 1 2 3\nLightSource \"projection\" \"rgb I\" [2 4 6] "
        "\"float fov\" 90 \"string mapname\" \"" +
        WriteBeam(directory) + "\"");
    // The shorter side spans 90 degrees: on the plane z = 1 the image is [-2, 2] x [-1, 1].
    const auto at = [&](float x, float y, float z) {
        return SampleOf(*s.scene, Vec3f(1, 2, 3) + Vec3f(x, y, z)).L;
    };
    for (int x = 0; x < 4; ++x)
        for (int y = 0; y < 2; ++y) {
            const Vec3f p(-1.5f + x, -0.5f + y, 1);
            const Rgb L = at(p.x(), p.y(), 1);
            EXPECT_NEAR(L.x(), 2 * (x + 10 * y) / p.squaredNorm(), 1e-3) << x << " " << y;
            EXPECT_NEAR(L.y(), 4 / p.squaredNorm(), 1e-4);
        }
    for (const Vec3f& p : {Vec3f(2.01f, 0, 1), Vec3f(0, -1.01f, 1), Vec3f(0, 0, -1)})
        EXPECT_TRUE(IsBlack(at(p.x(), p.y(), p.z())));
    const Rgb power = std::get<ProjectionLight>(s.scene->lights[0]).Power();
    EXPECT_NEAR(power.y(), 2 * kPi * (1 - 1 / std::sqrt(6.f)) * 4, 1e-3);
}

std::string Sun(double angle) {
    return fmt::format(
        "LightSource \"distant\" \"rgb L\" [1 2 3] \"point from\" [.6 0 .8] "
        "\"point to\" [0 0 0] \"float angle\" [{}]",
        angle);
}
const Vec3f kTowardsSun(0.6f, 0, 0.8f);

// A surface has the irradiance that a parallel light of the same L would give it, at every angle at
// which all of the disc is above its horizon.
TEST(SunLight, HasTheIrradianceOfAParallelLight) {
    for (const double angle : {0.01, 0.526, 5., 60., 180.}) {
        const LightScene test(Sun(angle));
        constexpr int n = 64;
        Eigen::Array3d facing = Eigen::Array3d::Zero(), inclined = facing;
        int unknown = 0;
        for (int i = 0; i < n * n; ++i) {
            const auto s = test.scene->lights.Sample(
                0, Vec3f::Zero(), {(float(i % n) + 0.5f) / n, (float(i / n) + 0.5f) / n});
            ASSERT_TRUE(s && !s->isDelta && s->isAtInfinity);
            facing += (s->L * (s->wi.dot(kTowardsSun) / s->pdf)).cast<double>() / (n * n);
            inclined += (s->L * (s->wi.z() / s->pdf)).cast<double>() / (n * n);
            const Emitted found = LeAndPdf(test.scene->lights[0], s->wi);
            unknown += found.pdf != s->pdf || (found.L != s->L).any();
        }
        EXPECT_LE(unknown, angle < 0.1 ? n : 0) << angle;
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(facing[c], c + 1, 2e-3 * (c + 1)) << angle;
            if (angle < 90) {
                EXPECT_NEAR(inclined[c], 0.8 * (c + 1), 2e-3 * (c + 1)) << angle;
            }
        }
        const Rgb power = std::get<SunLight>(test.scene->lights[0]).Power();
        const LightScene parallel(Sun(0));
        EXPECT_TRUE(
            power.isApprox(std::get<DistantLight>(parallel.scene->lights[0]).Power(), 1e-6f));
    }
}

TEST(SunLight, IsADisc) {
    for (const double angle : {0.526, 20., 120.}) {
        const LightScene test(Sun(angle));
        const double radius = angle / 2 * std::numbers::pi / 180;
        // Rings and sectors of the same solid angle.
        test::SphereGrid grid{{{}, {}, kTowardsSun}, {0}, 8};
        CoordinateSystem(grid.frame.n, &grid.frame.s, &grid.frame.t);
        constexpr int kSamples = 64000;
        for (int i = 1; i <= 8; ++i)
            grid.theta.push_back(2 * std::asin(std::sin(radius / 2) * std::sqrt(i / 8.)));
        grid.theta.push_back(std::numbers::pi);
        std::vector<int> counts(size_t(grid.CellCount()));
        Random random(5);
        for (int k = 0; k < kSamples; ++k) {
            const auto s = test.scene->lights.Sample(0, Vec3f::Zero(), random.Point());
            ASSERT_TRUE(s);
            ++counts[size_t(grid.CellOf(s->wi))];
            EXPECT_NEAR(s->pdf * 2 * std::numbers::pi * (1 - std::cos(radius)), 1, 1e-4);
        }
        const double expected = kSamples / 64.;
        double chi2 = 0;
        int outside = 0;
        for (size_t i = 0; i < counts.size(); ++i)
            if (i < 64)
                chi2 += Sqr(counts[i] - expected) / expected;
            else
                outside += counts[i];
        EXPECT_GT(test::UpperGamma(63 / 2., chi2 / 2), 1e-3) << angle;
        EXPECT_LE(outside, kSamples / 1000) << angle;
        EXPECT_GT(LeAndPdf(test.scene->lights[0], kTowardsSun).pdf, 0);
        EXPECT_EQ(LeAndPdf(test.scene->lights[0], -kTowardsSun).pdf, 0);
    }
}

// The edge of a roof at a height of 1 leaves the share of the disc that shows beyond it.
TEST(SunLight, HasAPenumbra) {
    const double angle = 10, radius = std::tan(angle / 2 * std::numbers::pi / 180);
    const auto scene = SceneOf(WorldText(fmt::format(
        "LightSource \"distant\" \"point from\" [0 0 1] \"point to\" [0 0 0] \"float angle\" [{}]\n"
        "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point P\" "
        "[0 -9 1  9 -9 1  9 9 1  0 9 1]",
        angle)));
    Random random(6);
    for (const double place : {-1.1, -0.9, -0.5, 0., 0.3, 0.8, 1.1}) {
        const Vec3f p(float(place * radius), 0, 0);
        int lit = 0;
        constexpr int kSamples = 20000;
        for (int k = 0; k < kSamples; ++k) {
            const auto s = scene->lights.Sample(0, p, random.Point());
            lit += !scene->accelerator.Occluded({p, s->wi, kInfinity});
        }
        const double x = std::clamp(place, -1., 1.);
        const double share = (std::acos(x) - x * std::sqrt(1 - x * x)) / std::numbers::pi;
        EXPECT_NEAR(lit / double(kSamples), share, 0.012) << place;
    }
}

TEST(SunLight, RefusesAnglesThatAreNone) {
    for (const double angle : {-1., 181.}) {
        const std::string error = ErrorOf([&] { LightScene scene(Sun(angle)); });
        EXPECT_TRUE(Contains(error, "\"angle\" is")) << error;
    }
}

// They are pbrt-v3's, whose two sides disagree.
TEST(AreaLights, WarnOfMirroredQuadrics) {
    const auto countOf = [](const std::string& text) {
        Warnings warnings;
        SceneOf(WorldText("AreaLightSource \"diffuse\" " + text), {}, &warnings);
        return warnings.Total();
    };
    for (const char* shape : {"sphere", "disk", "cylinder"}) {
        const std::string rest = fmt::format("\nShape \"{}\"", shape);
        EXPECT_EQ(countOf("Scale -1 1 1" + rest), 1) << shape;
        EXPECT_EQ(countOf("Scale -1 -1 1" + rest), 0) << shape;
        EXPECT_EQ(countOf("\"bool twosided\" \"true\" Scale -1 1 1" + rest), 0) << shape;
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
        const Rgb L = LeAndPdf(scene->lights[0], Vec3f(std::cos(phi), std::sin(phi), 0)).L;
        EXPECT_LT((L - expected[i]).abs().maxCoeff(), 1e-3f) << i;
    }
    EXPECT_EQ(warnings.Counts().at("environment map texel that is not finite or negative"), 2);
}

// In pbrt-v3 they are balls of air in glass.
TEST(Shapes, WarnOfMirroredQuadricsOfGlass) {
    const auto isWarnedOf = [](const std::string& text) {
        Warnings warnings;
        SceneOf(WorldText(text + "\nShape \"sphere\""), {}, &warnings);
        for (const auto& [kind, count] : warnings.Counts())
            if (Contains(kind, "inside out")) return true;
        return false;
    };
    const std::string mirror = "Scale 1 -1 1 ";
    EXPECT_TRUE(isWarnedOf(mirror + "Material \"glass\""));
    EXPECT_FALSE(isWarnedOf(mirror + "Material \"glass\" ReverseOrientation"));
    EXPECT_FALSE(isWarnedOf(mirror + "Material \"mirror\""));
    EXPECT_FALSE(isWarnedOf("Material \"glass\""));
}

TEST(ImageLights, RefuseWhatTheyCannotRead) {
    for (const char* light : {"\"projection\" \"float fov\" 181", "\"projection\" \"float fov\" 0",
                              "\"goniometric\" \"string mapname\" \"missing.exr\"",
                              "\"projection\" \"string mapname\" \"missing.exr\""}) {
        const std::string error =
            ErrorOf([&] { LightScene scene(std::string("LightSource ") + light); });
        EXPECT_TRUE(Contains(error, "test.pbrt:3: ")) << light << ": " << error;
    }
}

}  // namespace
}  // namespace lull
