// Compares the light that lights send out with their power, and its directions with their density.
#include "renderer/scene/lights/light_emission.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/renderer/scene_of.h"

namespace lull::light_emission_test {
namespace {

struct Lit {
    std::string name, light;
    bool hasKnownPower;  // other kinds know theirs about
    bool hasOneDirection = false;
    bool isDarkInPart = false;  // where directions are sampled that have no light
};

class LightEmissions : public testing::TestWithParam<Lit> {
  protected:
    std::unique_ptr<const Scene> scene =
        SceneOf(WorldText(GetParam().light + "\n" + Quad("-2 -2 -2  2 -2 -2  2 2 2  -2 2 2")));
    LightEmission emission{scene->lights, scene->shapes.bounds};
    std::mt19937 random{5};

    float Next() { return float(random() >> 8) * 0x1p-24f; }
    std::optional<EmittedRay> Sample() {
        const float u = Next();
        const Vec2f origin(Next(), Next()), direction(Next(), Next());
        return emission.Sample(u, origin, direction);
    }
};

TEST_P(LightEmissions, SendOutTheirPower) {
    test::SampleMean mean;
    for (int i = 0; i < 100000; ++i) {
        const auto ray = Sample();
        mean.Add(ray ? double(Luminance(ray->Power())) : 0);
    }
    double expected = 0;
    for (int i = 0; i < scene->lights.Count(); ++i) {
        const Light& light = scene->lights[i];
        const double power =
            double(Luminance(std::visit([](const auto& l) { return l.Power(); }, light)));
        // Of a sky it is that for one steradian.
        expected += TypeOf(light) == LightType::Infinite ? 4 * double(kPi) * power : power;
    }
    // Lights at infinity shine through a disk a little larger than the scene; the power of some
    // lights is known about.
    const double tolerance = GetParam().hasKnownPower ? 0.0025 : 0.35;
    EXPECT_NEAR(mean.Value(), expected, 4 * mean.Error() + tolerance * expected);
}

// Counts directions in cells of a sphere, and compares with the integral of the density.
TEST_P(LightEmissions, HaveTheirDensity) {
    if (GetParam().hasOneDirection || GetParam().isDarkInPart) return;
    constexpr int kRows = 8, kColumns = 16, kFine = 32, kCount = 200000;
    std::vector<double> found(kRows * kColumns, 0), expected(kRows * kColumns, 0);
    const auto cellOf = [](const Vec3f& w) {
        const float phi = std::atan2(w.y(), w.x()) / (2 * kPi) + 0.5f;
        return size_t(std::min(int((0.5f * w.z() + 0.5f) * kRows), kRows - 1) * kColumns +
                      std::min(int(phi * kColumns), kColumns - 1));
    };
    int taken = 0;
    std::optional<EmittedRay> any;
    while (taken < kCount) {
        const auto ray = Sample();
        ++taken;
        if (!ray) continue;
        ++found[cellOf(ray->w)];
        any = ray;
        const EmissionDensity density = emission.Density(ray->light, ray->n, ray->w);
        ASSERT_EQ(density.origin, ray->density.origin);
        ASSERT_EQ(density.onward, ray->density.onward);
    }
    ASSERT_TRUE(any);
    for (int row = 0; row < kRows; ++row) {
        const float low = std::acos(1 - 2 * float(row) / kRows);
        const float step = (std::acos(1 - 2 * float(row + 1) / kRows) - low) / kFine;
        for (int fine = 0; fine < kFine; ++fine)
            for (int column = 0; column < kColumns * kFine; ++column) {
                const float theta = low + (float(fine) + 0.5f) * step, r = std::sin(theta);
                const float phi = 2 * kPi * ((float(column) + 0.5f) / (kColumns * kFine) - 0.5f);
                const Vec3f w(r * std::cos(phi), r * std::sin(phi), std::cos(theta));
                const EmissionDensity density = emission.Density(any->light, any->n, w);
                expected[cellOf(w)] += double(any->isAtInfinity ? density.origin : density.onward) *
                                       kCount * double(r * step * 2 * kPi / (kColumns * kFine));
            }
    }
    double chi2 = 0;
    int cells = 0;
    for (size_t i = 0; i < found.size(); ++i) {
        if (expected[i] < 5) {
            EXPECT_LT(found[i], 30);
            continue;
        }
        chi2 += (found[i] - expected[i]) * (found[i] - expected[i]) / expected[i];
        ++cells;
    }
    EXPECT_LT(chi2, cells + 5 * std::sqrt(2. * cells) + 10) << cells;
}

std::string LampDisk(const std::string& parameters) {
    return "AttributeBegin Rotate 30 1 1 0 AreaLightSource \"diffuse\" " + parameters +
           " Shape \"disk\" AttributeEnd";
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, LightEmissions,
    testing::Values(
        Lit{"Point", R"(LightSource "point" "rgb I" [1 2 3])", true},
        Lit{"Spot", R"(LightSource "spot" "point to" [.3 .2 1] "float coneangle" [50]
"float conedeltaangle" [20])",
            false},
        Lit{"Distant", R"(LightSource "distant" "point from" [1 2 3])", true, true},
        Lit{"Infinite", R"(LightSource "infinite" "rgb L" [1 2 3])", true},
        Lit{"Studio", R"(LightSource "infinite" "bool studio" "true")", false},
        Lit{"Goniometric", R"(LightSource "goniometric" "rgb I" [1 2 3])", true},
        Lit{"Projection", R"(Rotate 30 1 1 0 LightSource "projection" "float fov" [70])", false,
            false, true},
        Lit{"Disk", LampDisk(""), true},
        Lit{"SpotWithARadius", R"(AttributeBegin AreaLightSource "spot-squared" "point to" [.3 .2 1]
"float coneangle" [50] "float conedeltaangle" [20] Shape "sphere" "float radius" [.1] AttributeEnd)",
            false, false, true},
        Lit{"Spread", LampDisk(R"("float spread" [100])"), true, false, true},
        Lit{"NarrowSpreadOnBothSides", LampDisk(R"("float spread" [5] "bool twosided" "true")"),
            true, false, true},
        Lit{"TwoSided", LampDisk(R"("bool twosided" "true")"), true}),
    kByName);

// Area lights are sampled evenly by area: the mean of points is the middle, the normals are right.
TEST(LightEmission, CoversShapes) {
    for (const char* shape : {"sphere", "cylinder", "disk"}) {
        const auto scene = SceneOf(WorldText(
            std::string("AttributeBegin Translate 1 2 3 AreaLightSource \"diffuse\" Shape \"") +
            shape + "\" AttributeEnd\nShape \"sphere\" \"float radius\" [9]\n"));
        const LightEmission emission(scene->lights, scene->shapes.bounds);
        std::mt19937 random(7);
        const auto next = [&] { return float(random() >> 8) * 0x1p-24f; };
        Vec3f sum = Vec3f::Zero();
        constexpr int kCount = 20000;
        for (int i = 0; i < kCount; ++i) {
            const float u = next();
            const Vec2f origin(next(), next()), direction(next(), next());
            const auto ray = emission.Sample(u, origin, direction);
            ASSERT_TRUE(ray);
            EXPECT_GT(ray->n.dot(ray->w), 0);
            // What a ray that comes back along the same way finds.
            Hit found;
            const Vec3f from = ray->p + 2 * ray->w;
            ASSERT_TRUE(scene->accelerator.Intersect({from, -ray->w, kInfinity}, &found));
            SurfaceInteraction hit;
            scene->shapes.Interact({from, -ray->w, kInfinity}, found, kNeedsNothing, &hit);
            if ((hit.p - ray->p).norm() < 1e-3f) {
                EXPECT_GT(hit.n.dot(ray->n), 0.99f) << shape;
                EXPECT_EQ(hit.areaLight, ray->light);
            }
            sum += ray->p;
        }
        EXPECT_NEAR((sum / float(kCount) - Vec3f(1, 2, 3)).norm(), 0, 0.03) << shape;
    }
}

TEST(LightEmission, IsNothingWithoutLights) {
    const auto scene = SceneOf(WorldText("Shape \"sphere\"\n"));
    const LightEmission emission(scene->lights, scene->shapes.bounds);
    EXPECT_FALSE(emission.Any());
    EXPECT_FALSE(emission.Sample(0.5f, {0.5f, 0.5f}, {0.5f, 0.5f}));
}

}  // namespace
}  // namespace lull::light_emission_test
