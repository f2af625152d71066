// Tests lenses: their files, that they focus, and that their rays carry the light that passes.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "renderer/scene/cameras/camera.h"
#include "renderer/scene/cameras/lens_system.h"
#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/scene/textures/texture_builder.h"

namespace lull {
namespace {

// Two achromats about a stop, as in tests/plugins/scenes/lens.dat; the focal length is about 42 mm.
constexpr const char* kLens =
    "# radius, thickness, index, diameter\n48 5 1.52 24\n-60 1.5 1.62 24\n-170 4 1 24\n0 4 0 18\n"
    "170 1.5 1.62 22\n60 5 1.52 22\n-48 30 1 22\n";

FilmSettings SquareFilm() {
    FilmSettings film;
    film.resolution = film.cropMax = {100, 100};
    return film;
}

Camera MakeLensCamera(const std::string& lens, std::vector<Parameter> parameters,
                      Warnings* warnings = nullptr) {
    const TemporaryDirectory directory;
    Description description;
    description.camera.name = "realistic";
    description.camera.loc = LocAt(3);
    description.camera.parameters.Add(String("lensfile", directory.Write("lens.dat", lens)));
    for (Parameter& p : parameters) description.camera.parameters.Add(std::move(p));
    Warnings silent;
    return MakeCamera(description, SquareFilm(), warnings ? *warnings : silent);
}

std::string CameraError(const std::string& lens, std::vector<Parameter> parameters = {}) {
    return ErrorOf([&] { MakeLensCamera(lens, std::move(parameters)); });
}

// Rays from one point of the film meet where it is in focus, up to the errors of such lenses, on
// the side of the image where that point is.
TEST(RealisticCamera, FocusesAtTheDistance) {
    const Camera camera = MakeLensCamera(
        kLens,
        {Float("aperturediameter", 6), Float("focusdistance", 2), Bool("simpleweighting", false)});
    EXPECT_TRUE(camera.HasLens());
    test::Random random(1);
    for (const Vec2f& film : {Vec2f(50, 50), Vec2f(70, 45), Vec2f(20, 30)}) {
        std::vector<Vec3f> points;
        for (int i = 0; i < 2000; ++i) {
            float weight;
            const Ray ray = camera.GenerateRay({film, random.Point()}, &weight);
            ASSERT_TRUE(weight >= 0 && std::isfinite(weight));
            if (weight == 0) continue;
            ASSERT_NEAR(ray.d.norm(), 1, 1e-5f);
            points.push_back(ray.o + ray.d * ((2 - ray.o.z()) / ray.d.z()));
        }
        ASSERT_GT(points.size(), 1000u);  // the bounds are not much larger than the pupil
        Vec3f mean = Vec3f::Zero();
        for (const Vec3f& p : points) mean += p / float(points.size());
        for (const Vec3f& p : points) EXPECT_LT((p - mean).norm(), 0.012f) << film.transpose();
        // 35 mm of diagonal before 42 mm: the image is 1.18 m wide at 2 m.
        const Vec2f expected = (film - Vec2f(50, 50)).cwiseProduct(Vec2f(1, -1)) * (1.14f / 100);
        EXPECT_NEAR((mean.head<2>() - expected).norm(), 0, 0.03f);
    }
}

// The mean weight of a point of the film equals the light through all of the rear lens.
TEST(RealisticCamera, WeighsByTheLightThatPasses) {
    const Camera camera =
        MakeLensCamera(kLens, {Float("aperturediameter", 17), Bool("simpleweighting", false),
                               Float("shutteropen", 1), Float("shutterclose", 3)});
    const Camera simple = MakeLensCamera(kLens, {Float("aperturediameter", 17)});
    test::Random random(2);
    const auto mean = [&](const Camera& c, const Vec2f& film) {
        double sum = 0;
        constexpr int kCount = 20000;
        for (int i = 0; i < kCount; ++i) {
            float weight;
            c.GenerateRay({film, random.Point()}, &weight);
            sum += weight;
        }
        return sum / kCount;
    };
    const double middle = mean(camera, {50, 50}), corner = mean(camera, {1, 1});
    // A disk of 17 mm seen at about 45 mm, for two seconds.
    EXPECT_NEAR(middle, 2 * kPi * Sqr(8.5 / 45), 0.06);
    EXPECT_LT(corner, 0.85 * middle);
    EXPECT_GT(corner, 0.6 * middle);
    // The two ways of weighting differ by a factor alone. A disk fills pi / 4 of its bounds, which
    // have a margin, and cos^4 is 0.97 or so.
    EXPECT_NEAR(mean(simple, {50, 50}), kPi / 4, 0.07);
    EXPECT_NEAR(mean(simple, {1, 1}) / mean(simple, {50, 50}), corner / middle, 0.02);
}

// Where light passes along the axis but not from the rest of the film, the rest is black.
TEST(RealisticCamera, MayLetNothingPass) {
    // Behind the lens a tube that is far too narrow for all but the middle. Both of its ends are
    // narrower than the aperture that is asked for.
    Warnings warnings;
    const Camera camera = MakeLensCamera("50 2 1.5 20\n0 60 0 1\n0 30 0 1\n-50 40 1 20\n",
                                         {Float("aperturediameter", 2)}, &warnings);
    EXPECT_EQ(warnings.Total(), 2);
    int dark = 0;
    test::Random random(3);
    for (int i = 0; i < 1000; ++i) {
        float weight;
        const Ray ray = camera.GenerateRay({{3, 3}, random.Point()}, &weight);
        EXPECT_TRUE(ray.o.allFinite() && ray.d.allFinite() && weight >= 0);
        dark += weight == 0;
        EXPECT_FALSE(camera.NextRay(ray, {{3, 3}}, 0).has_value());
    }
    EXPECT_EQ(dark, 1000);
    EXPECT_HAS(CameraError(kLens, {Float("aperturediameter", 0)}),
               "scene.pbrt:3: no light passes the lenses of '");
}

TEST(RealisticCamera, RefusesNonsense) {
    EXPECT_HAS(CameraError("48 5 1.52"), "has 3 numbers; four are needed");
    EXPECT_HAS(CameraError(""), "has 0 numbers");
    EXPECT_HAS(CameraError("1 2 3\n4 five"), "lens.dat:2: 'five' in a lens file");
    EXPECT_HAS(CameraError("48 5 1.5 inf"), "not a number");
    EXPECT_HAS(CameraError("48 5 1.5 -3"), "diameter of -3 mm in row 1");
    EXPECT_HAS(CameraError("48 5 1.5 3 48 5 -1 3"), "refraction of -1 in row 2");
    EXPECT_HAS(CameraError("48 1e20 1.5 3"), "thickness beyond");
    EXPECT_HAS(CameraError(kLens, {Float("focusdistance", 0.05f)}), "cannot focus at 0.05 m");
    EXPECT_HAS(CameraError(kLens, {Float("focusdistance", -1)}), "above 0");
    EXPECT_HAS(CameraError(kLens, {String("lensfile", "")}), "\"lensfile\"");
    EXPECT_HAS(CameraError(kLens, {String("lensfile", "nowhere.dat")}), "scene.pbrt:3: ");
}

}  // namespace
}  // namespace lull

namespace lull::lens_bundle_test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

// A ball of glass with a stop before it, on the side of the scene.
const std::vector<LensInterface> kBall = {{0, 0.5, 1, 0.4}, {1, 2, 1.5, 0.9}, {-1, 3, 1, 0.9}};
constexpr double kRearZ = 3;

LensBundle Traced(const std::vector<Vector2d>& rear) {
    LensBundle rays;
    for (const Vector2d& r : rear) rays.Add({0.1, 0, 0}, {r.x(), r.y(), kRearZ});
    rays.TraceFromFilm(kBall);
    return rays;
}

// Refracts by Snell's law, in the plane that holds the axis.
TEST(LensBundle, Refracts) {
    const std::vector<LensInterface> surface = {{-1, 3, 1.5, 0.9}};
    LensBundle rays;
    rays.Add({0, 0, 0}, {0, 0.3, kRearZ});
    rays.Add({0.3, 0, 0}, {0.3, 0, kRearZ});
    rays.TraceFromFilm(surface);
    ASSERT_EQ(rays.count, 2u);
    for (size_t i = 0; i < 2; ++i) {
        const Vector3d before = i == 0 ? Vector3d(0, 0.3, kRearZ).normalized() : Vector3d(0, 0, 1);
        const Vector3d at(rays.ox[i], rays.oy[i], rays.oz[i]);
        const Vector3d after(rays.dx[i], rays.dy[i], rays.dz[i]);
        const Vector3d normal = at - Vector3d(0, 0, kRearZ + 1);
        EXPECT_NEAR(normal.norm(), 1, 1e-12);
        EXPECT_LT(normal.z(), 0);  // the half that is turned to the film
        EXPECT_NEAR(after.norm(), 1, 1e-12);
        EXPECT_NEAR((1.5 * before.cross(normal) - after.cross(normal)).norm(), 0, 1e-12);
        EXPECT_GT(after.z(), 0);
    }
}

// However many others there are, each goes its own way.
TEST(LensBundle, KeepsThoseThatGetThrough) {
    std::vector<Vector2d> rear, alone;
    for (size_t i = 0; i < LensBundle::kMost; ++i)
        rear.push_back({-1 + 2 * double(i % 8) / 7, -1 + 2 * double(i / 8) / 7});
    for (const Vector2d& r : rear)
        if (Traced({r}).count == 1) alone.push_back(r);
    ASSERT_GT(alone.size(), 3u);
    ASSERT_LT(alone.size(), rear.size() - 3);
    const LensBundle all = Traced(rear);
    EXPECT_EQ(std::vector(all.rear.begin(), all.rear.begin() + long(all.count)), alone);
    for (size_t i = 0; i < all.count; ++i) {
        // Up to the rounding of what a compiler fuses, of vectors of rays or of the one left over.
        EXPECT_NEAR(all.ox[i], Traced({alone[i]}).ox[0], 1e-12);
        EXPECT_LE(std::hypot(all.ox[i], all.oy[i]), 0.4);
    }
}

}  // namespace
}  // namespace lull::lens_bundle_test
