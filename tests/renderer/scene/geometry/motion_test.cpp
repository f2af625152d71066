// Tests what moves while the shutter is open: transforms between two, their bounds, and that a
// moving scene is at each time the scene that stands where it is then.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/renderer/scene_of.h"

namespace lull {
namespace {

using test::Random;

Mat4d Translation(double x, double y, double z) {
    return Eigen::Affine3d(Eigen::Translation3d(x, y, z)).matrix();
}

Mat4d Rotation(double degrees, const Eigen::Vector3d& axis) {
    return Eigen::Affine3d(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis.normalized()))
        .matrix();
}

AnimatedTransform InUnitTime(const Mat4d& start, const Mat4d& end) {
    return {start, end, 0, 1, {}};
}

TEST(Motion, GoesFromOneTransformToTheOther) {
    const Eigen::Vector3d axis(1, 2, 3);
    Mat4d shear = Mat4d::Identity();
    shear(0, 1) = 0.4;
    const Mat4d start = Translation(1, 2, 3) * shear;
    const Mat4d end = Translation(3, 2, 1) * Rotation(90, axis) * shear;
    const AnimatedTransform motion = InUnitTime(start, end);
    EXPECT_EQ(motion.At(0), start);
    EXPECT_EQ(motion.At(1), end);
    const Mat4d half = Translation(2, 2, 2) * Rotation(45, axis) * shear;
    EXPECT_LT((motion.At(0.5) - half).norm(), 0.15);  // shear has a share in the rotation
    EXPECT_LT((motion.At(1e-7) - start).norm(), 1e-6);
    EXPECT_LT((motion.At(1 - 1e-7) - end).norm(), 1e-6);
    EXPECT_FALSE(motion.IsConstant());
    EXPECT_FALSE(motion.IsLinear());

    const AnimatedTransform turn = InUnitTime(Mat4d::Identity(), Rotation(90, axis));
    EXPECT_LT((turn.At(0.5) - Rotation(45, axis)).norm(), 1e-12);
    EXPECT_LT((turn.At(0.2) - Rotation(18, axis)).norm(), 1e-12);
}

TEST(Motion, TakesTheShorterArcAndPbrtsOfHalfATurn) {
    const Eigen::Vector3d z(0, 0, 1);
    const auto half = [&](double degrees, const Eigen::Vector3d& axis) {
        return InUnitTime(Mat4d::Identity(), Rotation(degrees, axis)).At(0.5);
    };
    EXPECT_LT((half(170, z) - Rotation(85, z)).norm(), 1e-12);
    EXPECT_LT((half(190, z) - Rotation(-85, z)).norm(), 1e-12);
    EXPECT_LT((half(180, z) - Rotation(-90, z)).norm(), 1e-12);
    EXPECT_LT((half(180, -z) - Rotation(90, z)).norm(), 1e-12);
    EXPECT_LT((half(360, z) - Mat4d::Identity()).norm(), 1e-12);
}

TEST(Motion, KeepsMirrors) {
    const Mat4d mirror = Eigen::Vector4d(-1, 2, 1, 1).asDiagonal();
    const AnimatedTransform motion = InUnitTime(mirror, Translation(2, 0, 0) * mirror);
    EXPECT_LT((motion.At(0.5) - Translation(1, 0, 0) * mirror).norm(), 1e-12);
    const AnimatedTransform turn = InUnitTime(mirror, Rotation(60, {0, 0, 1}) * mirror);
    EXPECT_LT((turn.At(0.5) - Rotation(30, {0, 0, 1}) * mirror).norm(), 1e-12);
}

TEST(Motion, StandsStillOutsideItsTimeAndIsCutByTheShutter) {
    const Mat4d start = Mat4d::Identity(), end = Translation(10, 0, 0);
    const AnimatedTransform motion(start, end, 2, 4, {.open = 1, .close = 5});
    EXPECT_EQ(motion.At(0), start);
    EXPECT_EQ(motion.At(0.25), start);
    EXPECT_NEAR(motion.At(0.5)(0, 3), 5, 1e-12);
    EXPECT_EQ(motion.At(0.75), end);
    EXPECT_FALSE(motion.IsLinear());
    const AnimatedTransform part(start, end, 0, 10, {.open = 2, .close = 3});
    EXPECT_NEAR(part.At(0)(0, 3), 2, 1e-12);
    EXPECT_NEAR(part.At(1)(0, 3), 3, 1e-12);
    EXPECT_TRUE(part.IsLinear());
}

TEST(Motion, IsConstantWhereTheShutterDoesNotSeeIt) {
    const Mat4d start = Mat4d::Identity(), end = Translation(10, 0, 0);
    const AnimatedTransform moment(start, end, 0, 1, {.open = 0.5, .close = 0.5});
    EXPECT_TRUE(moment.IsConstant());
    for (const double time : {0., 0.5, 1.}) EXPECT_NEAR(moment.At(time)(0, 3), 5, 1e-12);
    EXPECT_TRUE(AnimatedTransform(start, end, 3, 4, {}).IsConstant());
    EXPECT_EQ(AnimatedTransform(start, end, 3, 4, {}).At(1), start);
    EXPECT_TRUE(AnimatedTransform(start, end, -4, -3, {}).IsConstant());
    EXPECT_EQ(AnimatedTransform(start, end, -4, -3, {}).At(0), end);
    EXPECT_TRUE(InUnitTime(end, end).IsConstant());
    EXPECT_FALSE(AnimatedTransform(start, end, 0.5, 0.5, {}).IsConstant());  // it jumps
    EXPECT_EQ(AnimatedTransform(start, end, 0.5, 0.5, {}).At(0.4), start);
    EXPECT_EQ(AnimatedTransform(start, end, 0.5, 0.5, {}).At(0.6), end);
}

TEST(Motion, BoundsHoldWhatMoves) {
    Random random(3);
    const auto transform = [&] {
        const Vec3f t = 3 * random.Direction(), axis = random.Direction(), s = random.Direction();
        return Mat4d(Translation(t.x(), t.y(), t.z()) *
                     Rotation(360 * random.Float(), axis.cast<double>()) *
                     Mat4d(Eigen::Vector4d(s.x() + 2, s.y() + 2, s.z() - 2, 1).asDiagonal()));
    };
    for (int k = 0; k < 200; ++k) {
        std::vector<AnimatedTransform> chain;
        const double startTime = 1.5 * random.Float() - 0.5;
        for (int i = 0; i <= k % 2; ++i)
            chain.emplace_back(transform(), k % 5 ? transform() : Mat4d(Translation(1, 2, 3)),
                               startTime, startTime + random.Float(), Shutter{});
        const Bounds3f box{{-1, -2, 0}, {1, 0.5f, 3}};
        const std::vector<Bounds3f> bounds = BoundMotion(chain, box);
        for (int i = 0; i < 400; ++i) {
            const double time = random.Float();
            const Vec3f u(random.Float(), random.Float(), random.Float());
            const Vec3f p =
                TransformPoint(ProductAt(chain, time), box.lower + u.cwiseProduct(box.Diagonal()));
            const double at = time * double(bounds.size() - 1);
            const size_t left = std::min(size_t(at), bounds.size() - 2);
            const float f = float(at - double(left));
            const Vec3f lower = (1 - f) * bounds[left].lower + f * bounds[left + 1].lower;
            const Vec3f upper = (1 - f) * bounds[left].upper + f * bounds[left + 1].upper;
            ASSERT_TRUE((lower.array() <= p.array() + 1e-4f).all() &&
                        (upper.array() >= p.array() - 1e-4f).all())
                << k << ' ' << time;
        }
    }
}

std::string Numbers(const Mat4d& m) {
    std::string text = "[";
    for (int i = 0; i < 16; ++i) text += fmt::format("{:.17g} ", m.data()[i]);
    return text + "]";
}

TEST(Motion, WarnsOfMirroredPoses) {
    const auto warningsOf = [](const char* end) {
        return WarningsOf(WorldText(std::string("ActiveTransform EndTime Scale ") + end +
                                        " ActiveTransform All Shape \"disk\" LightSource \"point\"",
                                    "Camera \"perspective\" \"float shutterclose\" 1"))
            .count(
                "motion from a pose to a mirrored one, which no rotation joins: it is turned and "
                "flattened between them");
    };
    EXPECT_EQ(warningsOf("-1 1 1"), 1u);
    EXPECT_EQ(warningsOf("-2 -1 1"), 0u);
}

// Instances, shapes, and shapes within instances that move, of each kind.
TEST(Motion, MovingScenesAreAtEachTimeTheScenesThatStandThere) {
    const Mat4d outer0 = Translation(0.3, -0.2, 0.1) * Rotation(70, {1, -1, 0.5});
    const Mat4d outer1 = Translation(-0.8, 0.9, 0.4) * Rotation(-50, {0, 1, 0.5}) *
                         Mat4d(Eigen::Vector4d(1.5, 1, 0.6, 1).asDiagonal());
    const Mat4d inner0 = Translation(1, 0.2, 0.3);
    const Mat4d inner1 = Rotation(140, {1, 2, 3}) * Translation(0.5, 0.2, 0.3);
    const auto at = [](const Mat4d& m) { return "Transform " + Numbers(m) + "\n"; };
    const auto moving = [&](const Mat4d& a, const Mat4d& b) {
        return "ActiveTransform StartTime " + at(a) + "ActiveTransform EndTime " + at(b) +
               "ActiveTransform All\n";
    };
    const std::string fixed =
        "Shape \"sphere\" \"float radius\" [.5] Shape \"trianglemesh\" \"integer indices\" "
        "[0 1 2] \"point P\" [-1 -1 .5  1 -1 .2  0 1 .3]\n";
    const std::string parts =
        "Shape \"cylinder\" \"float radius\" [.3] \"float zmax\" .4 \"float zmin\" -.2\n";
    const auto world = [&](const std::string& outer, const std::string& inner) {
        return "ObjectBegin \"o\" " + fixed + "AttributeBegin " + inner + parts +
               "AttributeEnd ObjectEnd AttributeBegin " + outer + "ObjectInstance \"o\" " +
               "AttributeEnd\n" + outer + "Shape \"disk\" \"float radius\" [.9]";
    };
    const std::string options =
        "TransformTimes .2 .7 Camera \"perspective\" \"float shutteropen\" .1 \"float "
        "shutterclose\" .9";
    const auto moved =
        SceneOf(WorldText(world(moving(outer0, outer1), moving(inner0, inner1)), options));
    EXPECT_TRUE(moved->isMoving);
    const Shutter shutter{0.1, 0.9};
    const AnimatedTransform outer(outer0, outer1, 0.2, 0.7, shutter);
    const AnimatedTransform inner(inner0, inner1, 0.2, 0.7, shutter);

    Random random(8);
    int hits = 0, differences = 0, escapes = 0;
    for (const float time : {0.f, 0.05f, 0.3f, 0.5f, 0.71f, 0.9f, 1.f}) {
        const auto still = SceneOf(WorldText(world(at(outer.At(time)), at(inner.At(time)))));
        EXPECT_FALSE(still->isMoving);
        for (int i = 0; i < 4000; ++i) {
            const Vec3f o = 6 * random.Direction(), to = 1.5f * random.Float() * random.Direction();
            const Ray ray{o, (to - o).normalized(), kInfinity};
            Hit a, b;
            const bool isHit = still->accelerator.Intersect(ray, &a);
            EXPECT_EQ(moved->accelerator.Occluded(ray, time),
                      moved->accelerator.Intersect(ray, &b, time));
            // At an outline rounding decides.
            if (moved->accelerator.Intersect(ray, &b, time) != isHit ||
                (isHit && std::abs(a.t - b.t) > 1e-3)) {
                ++differences;
                continue;
            }
            if (!isHit) continue;
            ++hits;
            SurfaceInteraction p, q;
            still->shapes.Interact(ray, a, kNeedsTangents, &p);
            moved->shapes.Interact(ray, b, kNeedsTangents, &q, time);
            ASSERT_NEAR((p.p - q.p).norm(), 0, 1e-4);
            ASSERT_GT(p.n.dot(q.n), 0.999) << i;
            ASSERT_NEAR((p.dpdu - q.dpdu).norm(), 0, 1e-2);
            // A ray that leaves does not meet the surface that it leaves.
            Hit again;
            if (moved->accelerator.Intersect(q.SpawnRay(q.n), &again, time) &&
                (again.t < 1e-4f && again.shape == b.shape))
                ++escapes;
        }
    }
    EXPECT_GT(hits, 3000);
    EXPECT_LE(differences, 5);
    EXPECT_EQ(escapes, 0);
}

TEST(Motion, CamerasMove) {
    const std::string moves = "ActiveTransform EndTime Translate -2 0 0 ActiveTransform All ";
    const auto scene = SceneOf(WorldText("Shape \"sphere\"", moves + "Camera \"perspective\""));
    EXPECT_TRUE(scene->isMoving);
    const Vec2f film(3, 4), lens(0, 0);
    const Ray first = scene->camera.GenerateRay({film, lens, 0});
    for (const float time : {0.f, 0.25f, 1.f}) {
        const Ray ray = scene->camera.GenerateRay({film, lens, time});
        EXPECT_NEAR((ray.o - Vec3f(2 * time, 0, 0)).norm(), 0, 1e-6);
        EXPECT_NEAR((ray.d - first.d).norm(), 0, 1e-6);
    }
    const auto still = SceneOf(WorldText(
        "Shape \"sphere\"",
        moves + "Camera \"perspective\" \"float shutteropen\" .5 \"float shutterclose\" .5"));
    EXPECT_FALSE(still->isMoving);
    EXPECT_NEAR((still->camera.GenerateRay({film, lens}).o - Vec3f(1, 0, 0)).norm(), 0, 1e-6);
    EXPECT_THROW(SceneOf(WorldText("", "Camera \"perspective\" \"float shutterclose\" 1e39")),
                 Error);
}

}  // namespace
}  // namespace lull
