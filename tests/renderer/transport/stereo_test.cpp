// Tests pairs of pictures for two eyes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/input/scene_edits.h"
#include "renderer/scene/cameras/camera.h"
#include "tests/renderer/scene_of.h"
#include "tests/renderer/transport/pixel_statistics.h"

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
