#include "renderer/scene/lights/point.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <numbers>

#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/renderer/scene/lights/light_scene.h"
#include "tests/renderer/scene_of.h"

namespace lull::emission_profile_test {
namespace {

using test::Random;

double FalloffAt(const Spread& spread, double theta) {
    const Vec3f w(float(std::sin(theta)), 0, float(std::cos(theta)));
    return double(Falloff(spread, Vec3f::UnitZ(), w));
}

TEST(EmissionProfile, KeepsThePower) {
    for (const double degrees : {1., 20., 90., 150., 179., 180.}) {
        const Spread spread = Spread::Make(degrees);
        const double half = degrees * std::numbers::pi / 360;
        constexpr int kSteps = 20000;
        double power = 0;  // of radiance 1
        for (int i = 0; i < kSteps; ++i) {
            const double theta = (i + 0.5) * half / kSteps;
            power += FalloffAt(spread, theta) * std::cos(theta) * std::sin(theta) * 2 *
                     std::numbers::pi * half / kSteps;
        }
        EXPECT_NEAR(power, std::numbers::pi, 2e-3) << degrees;
        if (degrees < 180) {
            EXPECT_EQ(FalloffAt(spread, 1.01 * half), 0) << degrees;
        }
        EXPECT_EQ(PowerFraction(spread), 1);
    }
}

// Worked out for 90 degrees across: (1 - tan theta) / (1 - pi / 4).
TEST(EmissionProfile, FallsByTheTangent) {
    const Spread spread = Spread::Make(90);
    EXPECT_NEAR(FalloffAt(spread, 0), 4.65979, 1e-4);
    EXPECT_NEAR(FalloffAt(spread, std::atan(0.25)), 0.75 * 4.65979, 1e-4);
    EXPECT_NEAR(Falloff(spread, -Vec3f::UnitZ(), Vec3f::UnitZ()), 4.65979f, 1e-4f);
    EXPECT_EQ(Falloff(spread, Vec3f::UnitZ(), Vec3f::UnitX()), 0);
}

// Down to the least there are numbers alone.
TEST(EmissionProfile, IsFiniteHoweverNarrow) {
    for (const double degrees : {1e-30, 1e-3, 0.1}) {
        const double falloff = FalloffAt(Spread::Make(degrees), 0);
        EXPECT_TRUE(std::isfinite(falloff) && falloff > 0) << degrees;
    }
}

TEST(EmissionProfile, RefusesOtherAngles) {
    for (const char* bad : {"0", "-1", "181"}) {
        const std::string error = ErrorOf([&] {
            SceneOf(WorldText(std::string("AreaLightSource \"diffuse\" \"float spread\" [") + bad +
                              "]\nShape \"sphere\"\n"));
        });
        EXPECT_HAS(error, "above 0 and at most 180 degrees") << bad << error;
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

// Writes a 4x2 image whose texel (x, y) is x + 10 y in red, and 1 in green and blue.
std::string WriteBeam(const TemporaryDirectory& directory) {
    return WriteMap(directory, "beam.exr", 4, 2, [](char channel, int i) {
        return channel == 'R' ? float(i % 4 + 10 * (i / 4)) : 1;
    });
}

LightSample SampleOf(const Scene& scene, const Vec3f& from) {
    const auto s = scene.lights.Sample(0, from, {0.5f, 0.5f});
    return s ? *s : LightSample{.L = Rgb::Zero(), .wi = {}, .pdf = 0, .isDelta = true};
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

TEST(ImageLights, RefuseWhatTheyCannotRead) {
    for (const char* light : {"\"projection\" \"float fov\" 181", "\"projection\" \"float fov\" 0",
                              "\"goniometric\" \"string mapname\" \"missing.exr\"",
                              "\"projection\" \"string mapname\" \"missing.exr\""}) {
        const std::string error =
            ErrorOf([&] { LightScene scene(std::string("LightSource ") + light); });
        EXPECT_HAS(error, "test.pbrt:3: ") << light << ": " << error;
    }
}

}  // namespace
}  // namespace lull::emission_profile_test
