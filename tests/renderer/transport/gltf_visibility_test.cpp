// Renders glTF files of which the camera or shadow rays do not see all.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/input/scene_edits.h"
#include "renderer/scene/cameras/camera.h"
#include "tests/renderer/scene_of.h"
#include "tests/renderer/transport/gltf_scene.h"
#include "tests/renderer/transport/pixel_statistics.h"

namespace lull::gltf_test {
namespace {

// A green sheet under the sun, above a white floor. Seen, the sheet is in the picture; hidden from
// the camera, the floor is, in its shadow unless it casts none. It is the node's property or the
// material's; the sheet is an instance, or moves, or shadow rays look for media, as there is glass.
TEST(GltfNode, MayBeHiddenFromTheCameraAndShadowRays) {
    for (const bool isHidden : {false, true})
        for (const bool isShadowless : {false, true})
            for (const std::string how : {"node", "material", "twice", "moving", "media"}) {
                GltfFile file;
                const int mesh = Square(&file, Matte(0, 1, 0));
                json sheet = {{"mesh", mesh}, {"translation", {0, 0, 1}}, {"scale", {3, 3, 1}}};
                json& owner = how == "material" ? file.root["materials"][0] : sheet;
                owner["extras"]["lull"] = {{"hiddenFromCamera", isHidden},
                                           {"castsNoShadow", isShadowless}};
                file.Node(sheet);
                if (how == "twice") {
                    sheet["translation"] = {100, 0, 0};
                    file.Node(sheet);
                }
                if (how == "moving") {
                    const int times = file.Floats({0, 1}, "SCALAR");
                    const int ways = file.Floats({0, 0, 1, 1, 0, 1}, "VEC3");
                    file.root["animations"] = {
                        {{"samplers", {{{"input", times}, {"output", ways}}}},
                         {"channels",
                          {{{"sampler", 0}, {"target", {{"node", 0}, {"path", "translation"}}}}}}}};
                }
                if (how == "media") {
                    json glass = Matte(1, 1, 1);
                    glass["extensions"] = {
                        {"KHR_materials_transmission", {{"transmissionFactor", 1}}},
                        {"KHR_materials_volume",
                         {{"thicknessFactor", 1},
                          {"attenuationDistance", 1},
                          {"attenuationColor", {0.5, 0.5, 0.5}}}}};
                    file.Node({{"mesh", Square(&file, glass)}, {"translation", {100, 0, 0}}});
                }
                file.Node({{"mesh", Square(&file, Matte(1, 1, 1))}});
                Sun(&file, Vec3f::UnitZ());
                LookDown(&file);
                const GltfOptions opened{.frame = 0, .shutter = 1};
                Description d = kFolder.Parse(file, how == "moving" ? opened : GltfOptions());
                for (const bool isBidirectional : {false, true}) {
                    if (isBidirectional && how == "media") continue;  // which bdpt has not
                    if (isBidirectional) d.integrator.name = "bdpt";
                    const Rgb seen = Measure(*Compiled(d, 4), Estimator::Combined, 16).mean * kPi;
                    EXPECT_NEAR(seen.x(), isHidden && isShadowless ? 1 : 0, 1e-4f)
                        << how << ' ' << isHidden << isShadowless << isBidirectional;
                    if (!isHidden) {
                        EXPECT_NEAR(seen.y(), 1, 1e-4f) << how;
                    }
                }
            }
}

// The camera sees no sphere of a hidden light, which lights the floor as the point does.
TEST(GltfNode, HidesTheSphereOfItsLight) {
    for (const bool isHidden : {false, true}) {
        GltfFile file;
        file.Node({{"mesh", Square(&file, Matte(1, 1, 1))}, {"scale", {0.05, 0.05, 1}}});
        json node = {{"translation", {0, 0, 1}}};
        if (isHidden) node["extras"] = {{"lull", {{"hiddenFromCamera", true}}}};
        file.Light(
            {{"type", "point"}, {"intensity", 683}, {"extras", {{"lull", {{"radius", 0.5}}}}}},
            node);
        LookDown(&file, 0.04);
        const Total t = Measure(*Compiled(file), Estimator::Combined, 1000);
        // A bulb that is seen adds its own radiance: a watt per steradian from a disk of that
        // radius.
        const double bulbs = isHidden ? 0 : 1 / (kPi * 0.25);
        EXPECT_NEAR(t.mean.y(), bulbs + 1 / kPi, 4.5 * t.error + 2e-3) << isHidden;
    }
}

// A lamp hidden from the camera lights the floor: of two parallel squares of side 2 at a distance
// of 1, each is lit by 0.4153 of what the other sends (Hottel's form factor).
TEST(GltfNode, ShinesWhereItIsHidden) {
    GltfFile file;
    json lamp = Lamp();
    lamp["doubleSided"] = true;
    file.Node({{"mesh", Square(&file, lamp)},
               {"translation", {0, 0, 1}},
               {"extras", {{"lull", {{"hiddenFromCamera", true}}}}}});
    file.Node({{"mesh", Square(&file, Matte(1, 1, 1))}});
    const Total t = Measure(*Compiled(file), Estimator::Combined, 4000);
    EXPECT_NEAR(t.mean.y(), 0.4153, 4.5 * t.error + 1e-4);
}

}  // namespace
}  // namespace lull::gltf_test

// Tests pairs of pictures for two eyes.

namespace lull {
namespace {

constexpr const char* kView =
    "Camera \"perspective\" \"float fov\" [40] \"float lensradius\" [{}] "
    "\"float focaldistance\" [4]\nFilm \"image\" \"integer xresolution\" [30] "
    "\"integer yresolution\" [20]\n";
constexpr const char* kWorld =
    "LightSource \"infinite\" \"rgb L\" [1 1 1]\n"
    "Texture \"t\" \"spectrum\" \"checkerboard\" \"float uscale\" 9 \"float vscale\" 9\n"
    "Material \"matte\" \"texture Kd\" \"t\"\nTranslate 0 0 4\nShape \"sphere\"\n";

std::unique_ptr<const Scene> SceneOfEyes(const std::vector<float>& stereo, const std::string& eye,
                                         float lens = 0) {
    Warnings warnings;
    Description d =
        ParsePbrt(TemporaryDirectory().Write("t.pbrt", WorldText(kWorld, fmt::format(kView, lens))),
                  warnings);
    if (!stereo.empty()) SetStereo(stereo, eye, &d);
    CompileOptions options;
    options.threads = 1;
    return Compile(d, options, warnings);
}

std::vector<Rgb> Samples(const Scene& scene, int firstColumn, int columns) {
    Sampler sampler(SamplerKind::SobolHalves, 3);
    std::vector<Rgb> samples;
    for (int y = 0; y < 20; ++y)
        for (int x = firstColumn; x < firstColumn + columns; ++x)
            for (uint32_t k = 0; k < 8; ++k)
                samples.push_back(
                    RenderSample(scene, Estimator::Combined, sampler, {x, y}, k).radiance);
    return samples;
}

bool AreEqual(const std::vector<Rgb>& a, const std::vector<Rgb>& b) {
    return std::ranges::equal(a, b, [](const Rgb& x, const Rgb& y) { return (x == y).all(); });
}

TEST(Stereo, EyesAreThoseOfThePair) {
    for (const float lens : {0.f, .1f}) {
        const auto pair = SceneOfEyes({.3f, 4}, "", lens);
        ASSERT_TRUE(pair->rightEye);
        EXPECT_EQ(pair->film.Region().Width(), 60);
        const std::vector<Rgb> left = Samples(*pair, 0, 30), right = Samples(*pair, 30, 30);
        EXPECT_TRUE(AreEqual(left, Samples(*SceneOfEyes({.3f, 4}, "left", lens), 0, 30)));
        EXPECT_TRUE(AreEqual(right, Samples(*SceneOfEyes({.3f, 4}, "right", lens), 0, 30)));
        EXPECT_FALSE(AreEqual(left, right));
    }
}

// Eyes at the same place see the same, with grain of their own.
TEST(Stereo, WithoutDistanceMeansAreEqual) {
    const auto left = SceneOfEyes({1e-6f, 0}, "left"), right = SceneOfEyes({1e-6f, 0}, "right");
    const auto meanOf = [](const Scene& scene) {
        return MeanOf(MeasurePixels(scene, Estimator::Combined, SamplerKind::Random, 200, 1));
    };
    const ImageMean a = meanOf(*left), b = meanOf(*right);
    EXPECT_NEAR(a.mean.y(), b.mean.y(), 4 * std::hypot(a.error.y(), b.error.y()));
    EXPECT_FALSE(AreEqual(Samples(*left, 0, 30), Samples(*right, 0, 30)));
}

// Disparity is f D (1 / z - 1 / C) pixels.
TEST(Stereo, DisparityFallsWithDepth) {
    constexpr float kDistance = .065f;
    const double f = 10 / std::tan(20 * std::numbers::pi / 180);
    for (const float convergence : {0.f, 2.f, 5.f}) {
        const auto pair = SceneOfEyes({kDistance, convergence}, "");
        for (const float z : {1.f, 2.f, 5.f, 1000.f}) {
            const Vec3f p(.1f * z, -.05f * z, z);
            const auto left = ViewOf(pair->camera, p, {}, 0);
            const auto right = ViewOf(*pair->rightEye, p, {}, 0);
            ASSERT_TRUE(left && right);
            const double expected =
                f * kDistance * (1 / double(z) - (convergence > 0 ? 1 / double(convergence) : 0));
            EXPECT_NEAR(left->film.x() - right->film.x(), expected, 1e-3);
            EXPECT_NEAR(left->film.y(), right->film.y(), 1e-4);  // no vertical parallax
        }
    }
}

TEST(Stereo, IsForPerspectiveCameras) {
    Entity camera{"orthographic", {}, {}};
    camera.parameters.Add({ParameterType::Float, "eyedistance", {}, std::vector<float>{1}});
    EXPECT_THROW(ReadStereo(camera), Error);
    EXPECT_EQ(SceneOfEyes({}, "")->film.Region().Width(), 30);
}

// The laboratory's camera for pbrt-v4 names no eye, or one.
TEST(Stereo, OfPbrt4) {
    const auto scene = [](const std::string& more) {
        return SceneOf(
            "Film \"rgb\" \"integer xresolution\" 30 \"integer yresolution\" 20\n"
            "Camera \"stereoscopic\" \"float eyeDistance\" 2 " +
            more + "\nWorldBegin\nLightSource \"infinite\"");
    };
    EXPECT_TRUE(scene("")->rightEye);
    EXPECT_EQ(scene("")->camera.position.x(), -1);
    EXPECT_EQ(scene("\"string view\" \"right\"")->camera.position.x(), 1);
    EXPECT_FALSE(scene("\"string view\" \"left\"")->rightEye);
}

}  // namespace
}  // namespace lull
