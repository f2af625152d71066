// A camera sees points where its rays go through them.
#include "renderer/scene/cameras/camera.h"

#include <gtest/gtest.h>

#include <random>

#include "tests/renderer/scene_of.h"

namespace lull::camera_view_test {
namespace {

const char* const kCameras[] = {
    "LookAt 1 2 -3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" [50]\n",
    "Scale -1 1 1 LookAt 1 2 -3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" [70] "
    "\"float lensradius\" [.1] \"float focaldistance\" [2]\n",
    "Scale 2 2 1.5 LookAt 1 2 -3  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" [60] "
    "\"float screenwindow\" [-.5 1 -.7 .2]\n",
    "ActiveTransform StartTime LookAt 1 2 -3  0 0 0  0 1 0\nActiveTransform EndTime "
    "LookAt 2 1 -2  0 0 0  0 1 .2\nActiveTransform All\nCamera \"perspective\"\n"};

TEST(CameraView, IsWhereRaysComeFrom) {
    std::mt19937 random(3);
    const auto next = [&] { return float(random() >> 8) * 0x1p-24f; };
    for (const char* camera : kCameras) {
        const auto scene =
            SceneOf(WorldText("Shape \"sphere\"\n",
                              std::string(camera) + "Film \"image\" \"integer xresolution\" [60] "
                                                    "\"integer yresolution\" [40]\n"));
        ASSERT_TRUE(SeesPoints(scene->camera));
        for (int i = 0; i < 100; ++i) {
            CameraSample sample;
            sample.film = {60 * next(), 40 * next()};
            sample.lens = {next(), next()};
            sample.time = next();
            const Ray ray = scene->camera.GenerateRay(sample);
            const Vec3f p = ray.o + (1 + 9 * next()) * ray.d;
            const auto view = ViewOf(scene->camera, p, sample.lens, sample.time);
            ASSERT_TRUE(view);
            EXPECT_NEAR((view->film - sample.film).norm(), 0, 2e-3) << camera;
            EXPECT_NEAR((view->lens - ray.o).norm(), 0, 1e-5);
            EXPECT_FALSE(ViewOf(scene->camera, ray.o - ray.d, sample.lens, sample.time));

            // The solid angle of a quarter of a pixel.
            const auto shifted = [&](float x, float y) {
                CameraSample other = sample;
                other.film += Vec2f(x, y);
                return Vec3f(scene->camera.GenerateRay(other).d.normalized());
            };
            const Vec3f a = shifted(0.25f, 0) - shifted(-0.25f, 0);
            const Vec3f b = shifted(0, 0.25f) - shifted(0, -0.25f);
            const float solidAngle = 4 * a.cross(b).norm();
            EXPECT_NEAR(view->perSolidAngle * solidAngle, 1, 0.01) << camera;
            EXPECT_NEAR(
                PixelsPerSolidAngle(scene->camera, ray.d, sample.time) / view->perSolidAngle, 1,
                1e-3);
        }
    }
}

// Light paths would show it what is nearer, or beyond.
TEST(CameraView, IsNotThatOfClippedCameras) {
    const auto scene = SceneOf(
        WorldText("Shape \"sphere\"\n", "Camera \"perspective\" \"float clipstart\" [2]\n"));
    EXPECT_FALSE(SeesPoints(scene->camera));
}

}  // namespace
}  // namespace lull::camera_view_test
