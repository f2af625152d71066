// Compares what the hierarchy of lights chooses with the probabilities that it states, and with
// what lights give.
#include "renderer/scene/lights/light_distribution.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/renderer/scene_of.h"

namespace lull {
namespace {

using test::Random;

Vec3f RandomPoint(Random* random, float size) {
    const Vec2f u = random->Point(), v = random->Point();
    return size * Vec3f(u.x() - 0.5f, u.y() - 0.5f, v.x() - 0.5f);
}

// Makes lights of all kinds in clusters of all sizes, some black.
std::vector<LightBounds> RandomLights(int count, Random* random) {
    std::vector<LightBounds> lights;
    Vec3f cluster = Vec3f::Zero();
    for (int i = 0; i < count; ++i) {
        if (i % 7 == 0) cluster = RandomPoint(random, 10);
        LightBounds light;
        const Vec2f u = random->Point(), v = random->Point();
        const Vec3f p = cluster + RandomPoint(random, std::pow(10.f, 1 - 4 * u.x()));
        light.box.Extend(p);
        if (i % 3) light.box.Extend(p + RandomPoint(random, u.y()));
        light.axis = SampleUniformSphere(v);
        light.cosNormals = i % 5 == 0 ? -1 : i % 5 == 1 ? 0.9f : 1;
        light.cosEmission = i % 4 == 0 ? 0.5f : 0;
        light.power = i % 11 == 0 ? 0 : std::pow(10.f, 3 * random->Point().x());
        light.isTwoSided = i % 2;
        lights.push_back(light);
    }
    return lights;
}

Receiver RandomReceiver(Random* random) {
    Receiver receiver{RandomPoint(random, 12), SampleUniformSphere(random->Point()),
                      random->Point().x() < 0.3f};
    if (random->Point().x() < 0.2f) receiver.n = Vec3f::Zero();
    return receiver;
}

TEST(LightHierarchy, ChoosesWithTheProbabilitiesThatItStates) {
    constexpr int kSamples = 20000, kReceivers = 12;
    Random random(1);
    for (const int count : {1, 2, 3, 17, 150})
        for (const int unboundedCount : {0, 2}) {
            std::vector<int> unbounded;
            for (int i = 0; i < unboundedCount && 2 * i < count; ++i) unbounded.push_back(2 * i);
            std::vector<LightBounds> lights = RandomLights(count, &random);
            const LightHierarchy tree(lights, unbounded);
            for (int r = 0; r < kReceivers; ++r) {
                const Receiver receiver = RandomReceiver(&random);
                std::vector<double> expected;
                double total = 0;
                for (int i = 0; i < count; ++i) {
                    expected.push_back(tree.Pmf(receiver, i));
                    ASSERT_TRUE(expected.back() >= 0);
                    total += expected.back();
                }
                EXPECT_LE(total, 1 + 1e-5);
                std::vector<int64_t> observed(size_t(count), 0);
                for (int k = 0; k < kSamples; ++k) {
                    float pmf = -1;
                    const int light = tree.Sample(receiver, random.Point().x(), &pmf);
                    ASSERT_GE(pmf, 0);
                    if (pmf == 0) continue;
                    ASSERT_TRUE(light >= 0 && light < count);
                    ASSERT_NEAR(pmf, expected[size_t(light)], 1e-4 * pmf);
                    ++observed[size_t(light)];
                }
                EXPECT_GT(test::ChiSquarePValue(expected, observed, kSamples),
                          test::Significance(10 * kReceivers))
                    << count << " lights, receiver " << r;
            }
        }
}

// Where every light can be seen, some light is always chosen.
TEST(LightHierarchy, ProbabilitiesSumToOneAmongPointLights) {
    Random random(2);
    std::vector<LightBounds> lights(1000);
    for (LightBounds& light : lights) {
        const Vec3f p = RandomPoint(&random, 10);
        light.box = {p, p};
        light.cosNormals = -1;
        light.power = 1;
    }
    const LightHierarchy tree(lights, {});
    for (int r = 0; r < 100; ++r) {
        Receiver receiver = RandomReceiver(&random);
        receiver.isTwoSided = true;
        double total = 0;
        for (int i = 0; i < 1000; ++i) total += tree.Pmf(receiver, i);
        EXPECT_NEAR(total, 1, 1e-4);
    }
}

// Neither coinciding lights, nor lights whose distances grow with each, nor extreme numbers make
// the tree large, deep or wrong.
TEST(LightHierarchy, StandsAnyArrangement) {
    Random random(3);
    for (const int arrangement : {0, 1, 2, 3}) {
        std::vector<LightBounds> lights(3000);
        for (size_t i = 0; i < lights.size(); ++i) {
            Vec3f p(1, 2, 3);
            if (arrangement == 1) p.x() = std::ldexp(1.f, int(i % 200) - 100);
            if (arrangement == 2) p = RandomPoint(&random, 1e18f);
            if (arrangement == 3) p.y() += float(i);
            lights[i].box = {p, p};
            lights[i].cosNormals = -1;
            lights[i].power = arrangement == 2 ? (i % 2 ? 1e27f : 1e-30f) : 1.f;
        }
        const LightHierarchy tree(lights, {});
        EXPECT_LE(tree.Bytes(), 100 * lights.size());
        for (int r = 0; r < 100; ++r) {
            Receiver receiver = RandomReceiver(&random);
            if (r == 0) receiver.p = lights[5].box.lower;
            receiver.isTwoSided = true;
            float pmf;
            const int light = tree.Sample(receiver, random.Point().x(), &pmf);
            if (pmf == 0) continue;  // in the plane of the receiver
            ASSERT_TRUE(pmf > 0 && pmf <= 1) << arrangement;
            ASSERT_NEAR(tree.Pmf(receiver, light), pmf, 1e-4 * pmf) << arrangement;
        }
    }
    float pmf = 1;
    LightHierarchy({}, {}).Sample({}, 0.5f, &pmf);
    EXPECT_EQ(pmf, 0);
}

std::unique_ptr<const Scene> MakeLights(const std::string& lights, const char* strategy,
                                        bool lightsAsPbrtV3 = false) {
    const std::string before = fmt::format(
        "Camera \"perspective\"\nIntegrator \"path\" \"string lightsamplestrategy\" \"{}\"",
        strategy);
    CompileOptions options;
    options.lightsAsPbrtV3 = lightsAsPbrtV3;
    return SceneOf(WorldText(lights + "\nShape \"sphere\"", before), options);
}

// A light that is never chosen gives nothing to a surface that only reflects.
TEST(LightHierarchy, LeavesNoLightOut) {
    Random random(4);
    std::string lights;
    for (int i = 0; i < 60; ++i) {
        const Vec3f p = RandomPoint(&random, 8);
        lights += fmt::format("AttributeBegin\nTranslate {} {} {}\nRotate {} 1 2 3\n", p.x(), p.y(),
                              p.z(), 360 * random.Point().x());
        if (i % 5 == 0) lights += "LightSource \"point\" \"rgb I\" [1 2 3]\n";
        if (i % 5 == 1) lights += "LightSource \"spot\" \"float coneangle\" [50]\n";
        if (i % 10 == 4)
            lights += "AreaLightSource \"diffuse\" \"float spread\" [60]\n";
        else if (i % 10 == 3)
            lights += "AreaLightSource \"spot-squared\" \"float coneangle\" [50]\n";
        else if (i % 5 >= 2)
            lights += fmt::format("AreaLightSource \"diffuse\" \"bool twosided\" \"{}\"\n",
                                  i % 2 ? "true" : "false");
        if (i % 5 == 2) lights += "Scale 1 1 -1\nShape \"disk\" \"float radius\" [.3]\n";
        if (i % 5 == 3) lights += "Shape \"sphere\" \"float radius\" [.2]\n";
        if (i % 5 == 4)
            lights +=
                "Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] "
                "\"point P\" [0 0 0  1 0 0  1 1 .3  0 1 0]\n";
        lights += "AttributeEnd\n";
    }
    const auto scene = MakeLights(lights + "LightSource \"infinite\"\n", "bvh");
    ASSERT_TRUE(scene->lights.HasHierarchy());
    int excluded = 0, given = 0;
    for (int r = 0; r < 300; ++r) {
        SurfaceInteraction hit;
        hit.p = RandomPoint(&random, 8);
        hit.pError = Vec3f::Zero();
        hit.n = hit.ns = SampleUniformSphere(random.Point());
        hit.wo = SampleUniformSphere(random.Point());
        const Vec3f side = FaceForward(hit.n, hit.wo);
        const Bsdf opaque({side.unitOrthogonal(), side.cross(side.unitOrthogonal()), side}, side);
        const LightChoice choice = scene->lights.Choice(hit, opaque, 0);
        for (int i = 0; i < scene->lights.Count(); ++i) {
            const bool isExcluded = choice.Pmf(i) == 0;
            excluded += isExcluded;
            for (int k = 0; k < 20; ++k) {
                const auto s = scene->lights.Sample(i, hit.p, random.Point());
                if (!s || IsBlack(s->L)) continue;
                // Rounding decides for rays within the surface, and grazing rays bring nothing.
                const bool gives =
                    s->wi.dot(side) > 1e-4f && (s->n.isZero() || std::abs(s->wi.dot(s->n)) > 1e-3f);
                given += gives;
                EXPECT_FALSE(isExcluded && gives) << "light " << i;
            }
        }
    }
    EXPECT_GT(excluded, 1000);
    EXPECT_GT(given, 10000);
}

TEST(LightHierarchy, IsForManyLights) {
    const auto lights = [](int count) {
        std::string text;
        for (int i = 0; i < count; ++i) text += "LightSource \"point\" \"point from\" [3 3 3]\n";
        return text;
    };
    EXPECT_FALSE(MakeLights(lights(100), "spatial")->lights.HasHierarchy());
    EXPECT_TRUE(MakeLights(lights(101), "spatial")->lights.HasHierarchy());
    EXPECT_FALSE(MakeLights(lights(101), "spatial", true)->lights.HasHierarchy());
    EXPECT_FALSE(MakeLights(lights(101), "power")->lights.HasHierarchy());
    EXPECT_TRUE(MakeLights(lights(2), "bvh", true)->lights.HasHierarchy());
}

}  // namespace
}  // namespace lull
