// Tests what is too large, too far away or too small for rays to be traced, and what is not.
#include "renderer/scene/geometry/shape.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "tests/renderer/files/test_files.h"
#include "tests/renderer/scene_of.h"

namespace lull {
namespace {

std::string ErrorIn(const std::string& options, const std::string& world) {
    return ErrorOf([&] { SceneOf(WorldText(world, options)); });
}

const char* const kObject = "ObjectBegin \"a\"\nShape \"sphere\"\nObjectEnd\n";

TEST(Reach, RefusesCamerasTooFarAway) {
    for (const char* options :
         {"LookAt 0 0 1.9e18 0 0 0 0 1 0\nCamera \"perspective\"",
          "\nCamera \"orthographic\" \"float screenwindow\" [-5e18 5e18 -5e18 5e18]",
          "\nCamera \"perspective\" \"float screenwindow\" [-1e25 1e25 -1e25 1e25]",
          "\nCamera \"perspective\" \"float lensradius\" [5e18]",
          "Scale 1e-20 1e-20 1e-20\nCamera \"orthographic\""})
        EXPECT_HAS(ErrorIn(options, "Shape \"sphere\""), "test.pbrt:2: ") << options;
    EXPECT_EQ(ErrorIn("LookAt 0 0 1e11 0 0 0 0 1 0\nCamera \"perspective\"", "Shape \"sphere\""),
              "");
}

TEST(Reach, RefusesShapesTooFarAway) {
    EXPECT_HAS(ErrorIn("", "Shape \"sphere\" \"float radius\" [1e18]"),
               "test.pbrt:3: Shape \"sphere\" reaches farther than 1e+12");
    EXPECT_HAS(ErrorIn("",
                       "Translate 0 0 1e30\nShape \"trianglemesh\" \"integer "
                       "indices\" [0 1 2] \"point P\" [0 0 0 1 0 0 0 1 0]"),
               "test.pbrt:4: Shape \"trianglemesh\" reaches");
}

TEST(Reach, RefusesUsedVerticesTooFarAway) {
    const std::string mesh =
        "Scale 1e10 1 1\nShape \"trianglemesh\" \"point P\" [0 0 0 1 0 0 0 1 0 1e37 0 0] "
        "\"integer indices\" ";
    EXPECT_HAS(ErrorIn("", mesh + "[0 1 3]"),
               "test.pbrt:4: vertex 3 is not finite once transformed");
    EXPECT_EQ(ErrorIn("", mesh + "[0 1 2]"), "");
}

TEST(Reach, RefusesInstancesThatNoRayCanBeFollowedInto) {
    EXPECT_HAS(ErrorIn("", kObject + std::string("Scale 1e-19 1 1\nObjectInstance \"a\"")),
               "test.pbrt:7: the instance's transform changes sizes");
    // Its determinant is no longer a float.
    EXPECT_HAS(ErrorIn("", kObject + std::string("Scale 1e-15 1e-15 1e-15\nObjectInstance \"a\"")),
               "test.pbrt:7: the instance's transform changes sizes");
    EXPECT_HAS(ErrorIn("", kObject + std::string("Scale 1 1 1e19\nObjectInstance \"a\"")),
               "test.pbrt:7: the instance reaches farther");
    EXPECT_EQ(ErrorIn("", kObject + std::string("Scale 1e-3 1e3 1\nObjectInstance \"a\"")), "");
}

TEST(Reach, RefusesLightsTooFarAway) {
    for (const char* kind : {"point", "spot", "goniometric", "projection"})
        EXPECT_HAS(ErrorIn("", "Translate 0 0 1e18\nLightSource \"" + std::string(kind) + "\""),
                   "test.pbrt:4: LightSource \"" + std::string(kind) + "\" lies farther")
            << kind;
}

// An instance that is smaller than its object makes rays longer.
TEST(Reach, IsThatOfAllInstances) {
    EXPECT_EQ(ReachThrough(Mat4d::Identity() * 1e-3), double(kFarthest));
    const auto scene = SceneOf("WorldBegin\n" + std::string(kObject) +
                               "Scale 1e-6 1e-6 1e-6\nObjectInstance \"a\"\nWorldEnd\n");
    EXPECT_LT(scene->shapes.reach, 1e12f);
    EXPECT_GT(scene->shapes.reach, 1e11f);
    EXPECT_HAS(ErrorIn("LookAt 0 0 1e13 0 0 0 0 1 0\nCamera \"perspective\"",
                       kObject + std::string("Scale 1e-6 1e-6 1e-6\nObjectInstance "
                                             "\"a\"")),
               "test.pbrt:2: rays of the camera");
}

// Triangles are what they are at any size: their normals come from products of two lengths, whose
// squares are no longer floats.
TEST(Reach, MeshesMayBeOfAnySize) {
    for (const double scale : {1e-12, 1e-10, 1., 1e10, 1e11}) {
        const auto scene = SceneOf(fmt::format(
            "WorldBegin\nScale {0} {0} {0}\nShape \"trianglemesh\" \"integer indices\" [0 1 2]"
            "\"point P\" [-1 -1 2  3 -1 2  -1 3 2]\nWorldEnd\n",
            scale));
        const float s = float(scale);
        Hit hit;
        const Ray ray{Vec3f::Zero(), Vec3f(0, 0, s), kInfinity};
        ASSERT_TRUE(scene->accelerator.Intersect(ray, &hit)) << scale;
        EXPECT_NEAR(hit.t, 2, 1e-5) << scale;
        SurfaceInteraction at;
        scene->shapes.Interact(ray, hit, kNeedsTangents, &at);
        EXPECT_NEAR(std::abs(at.n.z()), 1, 1e-6) << scale;
        EXPECT_NEAR(at.n.norm(), 1, 1e-6) << scale;
        EXPECT_NEAR(std::get<Mesh>(scene->shapes.shapes[0].geometry).Area(0) / s / s, 8, 1e-4)
            << scale;
    }
}

TEST(Reach, SpheresMayBeOfAnySize) {
    for (const double scale : {1e-10, 1., 1e10, 1e11}) {
        const auto scene = SceneOf(fmt::format(
            "WorldBegin\nTranslate 0 0 {0}\nShape \"sphere\" \"float radius\" [{1}]\nWorldEnd\n",
            4 * scale, scale));
        Hit hit;
        const Ray ray{Vec3f::Zero(), Vec3f(0.1f, 0, 1), kInfinity};
        ASSERT_TRUE(scene->accelerator.Intersect(ray, &hit)) << scale;
        SurfaceInteraction at;
        scene->shapes.Interact(ray, hit, kNeedsTangents, &at);
        EXPECT_NEAR(at.n.norm(), 1, 1e-6) << scale;
        EXPECT_LT(at.n.z(), -0.8f) << scale;
    }
}

TEST(Reach, WarnsOfScenesTooSmallForTriangles) {
    const auto warningsOf = [](double scale) {
        return WarningsOf(
            WorldText(fmt::format("Scale {0} {0} {0}\nShape \"trianglemesh\" "
                                  "\"integer indices\" [0 1 2] \"point P\" [0 0 0 1 0 0 0 1 0]",
                                  scale)));
    };
    const std::string kind = "the scene is too small for its light to be right";
    EXPECT_EQ(warningsOf(1e-10).count(kind), 1u);
    EXPECT_EQ(warningsOf(1e-4).count(kind), 0u);
}

}  // namespace
}  // namespace lull
