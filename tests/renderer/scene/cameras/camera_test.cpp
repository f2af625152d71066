#include <gtest/gtest.h>

#include <random>

#include "renderer/scene/cameras/camera.h"
#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/scene/textures/texture_builder.h"
#include "tests/renderer/scene_of.h"

namespace lull {
namespace {

FilmSettings FilmOf(int width, int height) {
    FilmSettings film;
    film.resolution = film.cropMax = {width, height};
    return film;
}

Camera MakeTestCamera(const FilmSettings& film, std::vector<Parameter> parameters,
                      const Mat4d& cameraFromWorld = Mat4d::Identity(),
                      const std::string& kind = "perspective") {
    Description description;
    description.camera.name = kind;
    description.camera.loc = LocAt(3);
    description.cameraFromWorld = cameraFromWorld;
    for (Parameter& p : parameters) description.camera.parameters.Add(std::move(p));
    Warnings warnings;
    return MakeCamera(description, film, warnings);
}

void ExpectNear(const Vec3f& a, const Vec3f& b, float tolerance = 1e-5f) {
    EXPECT_NEAR((a - b).norm(), 0, tolerance) << a.transpose() << " vs " << b.transpose();
}

Vec3f Direction(const Camera& camera, float x, float y) {
    return camera.GenerateRay({{x, y}, {0.5f, 0.5f}}).d;
}

TEST(Camera, LooksAlongZWithTheFieldOfViewOnTheShorterAxis) {
    const float t = std::tan(kPi / 6);  // half of 60 degrees
    const Camera wide = MakeTestCamera(FilmOf(200, 100), {Float("fov", 60)});
    ExpectNear(Direction(wide, 100, 50), Vec3f(0, 0, 1));
    // Film y points down, camera y up, and x to the right.
    ExpectNear(Direction(wide, 0, 0), Vec3f(-2 * t, t, 1).normalized());
    ExpectNear(Direction(wide, 200, 0), Vec3f(2 * t, t, 1).normalized());
    ExpectNear(Direction(wide, 0, 100), Vec3f(-2 * t, -t, 1).normalized());
    ExpectNear(Direction(wide, 200, 100), Vec3f(2 * t, -t, 1).normalized());
    const Camera tall = MakeTestCamera(FilmOf(100, 200), {Float("halffov", 30)});
    ExpectNear(Direction(tall, 0, 0), Vec3f(-t, 2 * t, 1).normalized());
    ExpectNear(wide.GenerateRay({{3, 4}, {0, 0}}).o, Vec3f::Zero());
}

TEST(Camera, FollowsScreenWindowAndAspect) {
    const Camera window =
        MakeTestCamera(FilmOf(100, 100), {Floats("screenwindow", {-0.5f, 0.25f, -1, 2})});
    ExpectNear(Direction(window, 0, 0), Vec3f(-0.5f, 2, 1).normalized());
    ExpectNear(Direction(window, 100, 100), Vec3f(0.25f, -1, 1).normalized());
    const Camera aspect = MakeTestCamera(FilmOf(100, 100), {Float("frameaspectratio", 3)});
    ExpectNear(Direction(aspect, 0, 0), Vec3f(-3, 1, 1).normalized());
    // By a quarter of its width to the right and a half of its height down.
    const Camera shifted =
        MakeTestCamera(FilmOf(200, 100), {Floats("screenshift", {0.25f, -0.5f})});
    ExpectNear(Direction(shifted, 0, 0), Vec3f(-1, 0, 1).normalized());
    ExpectNear(Direction(shifted, 200, 100), Vec3f(3, -2, 1).normalized());
}

TEST(Camera, SeesBetweenTwoPlanes) {
    for (const char* kind : {"perspective", "orthographic"})
        for (const float lens : {0.f, 0.1f}) {
            const Camera camera =
                MakeTestCamera(FilmOf(200, 100),
                               {Float("clipstart", 2), Float("clipend", 5),
                                Float("lensradius", lens), Float("focaldistance", 3)},
                               Mat4d::Identity(), kind);
            const Ray ray = camera.GenerateRay({{20, 10}, {0.9f, 0.3f}});
            EXPECT_NEAR(ray.o.z(), 2, 1e-5f) << kind;
            EXPECT_NEAR((ray.o + ray.tMax * ray.d).z(), 5, 1e-5f) << kind;
            const Ray whole = MakeTestCamera(FilmOf(200, 100),
                                             {Float("lensradius", lens), Float("focaldistance", 3)},
                                             Mat4d::Identity(), kind)
                                  .GenerateRay({{20, 10}, {0.9f, 0.3f}});
            ExpectNear(ray.d, whole.d);
            ExpectNear(ray.o, whole.o + (2 - whole.o.z()) / whole.d.z() * whole.d);
        }
}

// glTF's cameras: all of what they show is in images of any aspect, and nothing is stretched.
TEST(Camera, FitsWhatItHasToShow) {
    const auto corner = [](int width, int height, float x, float y, const char* kind) {
        const Camera camera = MakeTestCamera(FilmOf(width, height), {Floats("screenfit", {x, y})},
                                             Mat4d::Identity(), kind);
        const Ray ray = camera.GenerateRay({{float(width), 0}, {0.5f, 0.5f}});
        return ray.d.x() == 0 ? Vec2f(ray.o.x(), ray.o.y()) : Vec2f(ray.d.head<2>() / ray.d.z());
    };
    for (const char* kind : {"perspective", "orthographic"}) {
        const auto expect = [&](int width, int height, float x, float y, const Vec2f& seen) {
            EXPECT_NEAR((corner(width, height, x, y, kind) - seen).norm(), 0, 1e-5f)
                << kind << " " << width << "x" << height << " " << x << " " << y;
        };
        // Without an aspect, the height is fixed.
        expect(100, 100, 0, 0.5f, {0.5f, 0.5f});
        expect(200, 100, 0, 0.5f, {1, 0.5f});
        expect(100, 200, 0, 0.5f, {0.25f, 0.5f});
        expect(150, 100, 0, 0.5f, {0.75f, 0.5f});
        // With aspects of 1 and 2, so is the width where that needs more.
        expect(100, 100, 0.5f, 0.5f, {0.5f, 0.5f});
        expect(200, 100, 0.5f, 0.5f, {1, 0.5f});
        expect(100, 200, 0.5f, 0.5f, {0.5f, 1});
        expect(100, 100, 1, 0.5f, {1, 1});
        expect(200, 100, 1, 0.5f, {1, 0.5f});
        expect(100, 200, 1, 0.5f, {1, 2});
        expect(150, 100, 1, 0.5f, {1, 2 / 3.f});
    }
}

// A crop is a part of the same picture.
TEST(Camera, DoesNotHeedTheCrop) {
    FilmSettings film = FilmOf(100, 80);
    const Camera whole = MakeTestCamera(film, {});
    film.cropMin = {25, 10};
    film.cropMax = {50, 20};
    EXPECT_EQ(Direction(whole, 30.5f, 12.25f), Direction(MakeTestCamera(film, {}), 30.5f, 12.25f));
}

Mat4d RigidTransform() {
    const Eigen::Affine3d t = Eigen::Translation3d(3, -2, 5) *
                              Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, -1).normalized());
    return t.matrix();
}

TEST(Camera, StandsWhereItsTransformSays) {
    const Mat4d worldFromCamera = RigidTransform();
    const Camera camera = MakeTestCamera(FilmOf(100, 100), {}, worldFromCamera.inverse());
    const Ray ray = camera.GenerateRay({{20, 70}, {0.5f, 0.5f}});
    ExpectNear(ray.o, Vec3f(3, -2, 5));
    ExpectNear(ray.d, TransformVector(worldFromCamera, Vec3f(-0.6f, -0.4f, 1).normalized()));
    EXPECT_NEAR((WorldToCamera(camera) - worldFromCamera.inverse()).norm(), 0, 1e-9);

    // A point on a ray is projected back to where the ray came from.
    const Vec3f p = ray.o + 7 * ray.d;
    const Vec3f ndc = TransformPoint(*WorldToNdc(camera, FilmOf(100, 100)), p);
    EXPECT_NEAR(ndc.x(), 0.2f, 1e-5);
    EXPECT_NEAR(ndc.y(), 0.7f, 1e-5);
}

TEST(Camera, LensRaysMeetInThePlaneOfFocus) {
    const Mat4d worldFromCamera = RigidTransform();
    const Camera lens =
        MakeTestCamera(FilmOf(100, 80), {Float("lensradius", 0.3f), Float("focaldistance", 4)},
                       worldFromCamera.inverse());
    const Camera pinhole = MakeTestCamera(FilmOf(100, 80), {}, worldFromCamera.inverse());
    test::Random random(1);
    double radius2 = 0;
    constexpr int kRays = 20000;
    for (int i = 0; i < kRays; ++i) {
        const Vec2f film = random.Point().cwiseProduct(Vec2f(100, 80));
        const Ray ray = lens.GenerateRay({film, random.Point()});
        ASSERT_NEAR(ray.d.norm(), 1, 1e-5);
        const auto inCamera = [&](const Vec3f& p) {
            return TransformPoint(WorldToCamera(lens), p);
        };
        const Vec3f o = inCamera(ray.o), d = inCamera(ray.o + ray.d) - o;
        ASSERT_NEAR(o.z(), 0, 1e-5);
        ASSERT_LE(o.norm(), 0.3001f);
        radius2 += o.squaredNorm() / kRays;
        const Vec3f straight = inCamera(pinhole.position + pinhole.GenerateRay({film, {0, 0}}).d);
        ASSERT_NEAR((o + d * (4 / d.z()) - straight * (4 / straight.z())).norm(), 0, 2e-4);
    }
    EXPECT_NEAR(radius2, 0.3 * 0.3 / 2, 0.001);
}

TEST(Camera, OrthographicRaysAreParallel) {
    const Mat4d worldFromCamera = RigidTransform();
    const FilmSettings film = FilmOf(200, 100);
    const Camera camera = MakeTestCamera(film, {Floats("screenwindow", {-3, 1, -2, 4})},
                                         worldFromCamera.inverse(), "orthographic");
    const Vec2f lens(0.5f, 0.5f);
    for (const Vec2f& p : {Vec2f(0, 0), Vec2f(200, 0), Vec2f(50, 70)}) {
        const Ray ray = camera.GenerateRay({p, lens});
        ExpectNear(ray.o, TransformPoint(worldFromCamera,
                                         Vec3f(-3 + 4 * p.x() / 200, 4 - 6 * p.y() / 100, 0)));
        ExpectNear(ray.d, TransformVector(worldFromCamera, Vec3f::UnitZ()));
        // Any point of the ray is projected back to where the ray came from.
        const Vec3f ndc = TransformPoint(*WorldToNdc(camera, film), Vec3f(ray.o + 3 * ray.d));
        EXPECT_NEAR(ndc.x(), p.x() / 200, 1e-5);
        EXPECT_NEAR(ndc.y(), p.y() / 100, 1e-5);
    }
    // The shorter axis holds [-1, 1] by default.
    const Camera wide = MakeTestCamera(film, {}, Mat4d::Identity(), "orthographic");
    ExpectNear(wide.GenerateRay({{0, 0}, lens}).o, Vec3f(-2, 1, 0));
}

TEST(Camera, OrthographicLensKeepsThePlaneOfFocus) {
    const Camera camera =
        MakeTestCamera(FilmOf(10, 10), {Float("lensradius", 0.2f), Float("focaldistance", 3)},
                       Mat4d::Identity(), "orthographic");
    test::Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const Vec2f p = 10 * random.Point();
        const Ray ray = camera.GenerateRay({p, random.Point()});
        ASSERT_LE(ray.o.norm(), 0.2001f);
        ASSERT_NEAR(ray.d.norm(), 1, 1e-5);
        const Vec3f focus = ray.o + ray.d * (3 / ray.d.z());
        ASSERT_NEAR((focus - Vec3f(-1 + p.x() / 5, 1 - p.y() / 5, 3)).norm(), 0, 1e-4);
    }
}

TEST(Camera, EnvironmentSeesAllDirections) {
    const Mat4d worldFromCamera = RigidTransform();
    const FilmSettings film = FilmOf(40, 20);
    const Camera camera =
        MakeTestCamera(film, {Float("lensradius", 2)}, worldFromCamera.inverse(), "environment");
    const auto inCamera = [&](float x, float y) {
        const Ray ray = camera.GenerateRay({{x, y}, {0.1f, 0.2f}});
        ExpectNear(ray.o, Vec3f(3, -2, 5));
        return TransformVector(WorldToCamera(camera), ray.d);
    };
    // The first row looks up along y, the middle one around the horizon, from x towards z.
    for (const float x : {0.f, 17.f}) ExpectNear(inCamera(x, 0), Vec3f(0, 1, 0));
    ExpectNear(inCamera(0, 10), Vec3f(1, 0, 0));
    ExpectNear(inCamera(10, 10), Vec3f(0, 0, 1));
    ExpectNear(inCamera(30, 10), Vec3f(0, 0, -1));
    ExpectNear(inCamera(5, 20), Vec3f(0, -1, 0));
    EXPECT_FALSE(WorldToNdc(camera, film).has_value());
}

// 180 degrees, which a plane does not show, and what rounding makes of them.
TEST(Camera, IsNearlyAsWideAsAsked) {
    for (const float fov : {180.f, 180.0001f, 179.94f}) {
        const Camera camera = MakeTestCamera(FilmOf(10, 10), {Float("fov", fov)});
        EXPECT_NEAR(std::acos(Direction(camera, 0, 5).z()) * 180 / kPi, 89.97, 1e-3) << fov;
    }
}

TEST(Camera, RefusesNonsense) {
    const auto error = [](const Parameter& parameter) {
        return ErrorOf([&] { MakeTestCamera(FilmOf(9, 9), {parameter}); });
    };
    for (const float fov : {0.f, -5.f, 181.f, std::nanf("")})
        EXPECT_HAS(error(Float("fov", fov)), "scene.pbrt:3: ");
    EXPECT_NE(ErrorOf([] { MakeTestCamera(FilmOf(9, 9), {}, Mat4d::Zero()); }), "");
    EXPECT_NE(error(Floats("screenwindow", {1, 2})), "");
    for (const float aspect : {0.f, -1.f, kInfinity})
        EXPECT_HAS(error(Float("frameaspectratio", aspect)), "has to be above 0");
    EXPECT_HAS(error(Floats("screenwindow", {1, 1, -1, 1})), "no extent");
    // No ray through these is finite.
    for (const Parameter& parameter :
         {Floats("screenwindow", {-3e38f, 3e38f, -1, 1}), Float("frameaspectratio", 1e-38f),
          Floats("screenfit", {1, 1e30f}), Floats("screenshift", {0, 1e20f})})
        EXPECT_HAS(error(parameter), "is the farthest") << parameter.name;
    Description description;
    description.camera.name = "fisheye";
    Warnings warnings;
    EXPECT_NE(ErrorOf([&] { MakeCamera(description, FilmOf(9, 9), warnings); }), "");
}

}  // namespace
}  // namespace lull

// A camera sees points where its rays go through them.

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
