#include <gtest/gtest.h>

#include "renderer/scene/textures/mapping.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/scene/textures/texture_builder.h"

namespace lull {
namespace {

// Makes the mapping that a texture with these parameters has.
Mapping2D Make(std::vector<Parameter> parameters, const Mat4d& worldFromTexture = Mat4d::Identity(),
               bool substitutes = false) {
    TextureBuilder builder(substitutes);
    builder.Add(false, "checkerboard", std::move(parameters), worldFromTexture);
    const TextureTable table;
    TextureImages images;
    const Mapping2D mapping = MakeMapping2D(
        {builder.description.textures[0], builder.description, table, images, builder.warnings});
    builder.warnings.ThrowErrors();
    return mapping;
}

void ExpectMap(const Mapping2D& mapping, const Vec3f& p, float s, float t) {
    const Vec2f st = Map(mapping, AtPoint(p));
    EXPECT_NEAR(st.x(), s, 1e-6f) << p.transpose();
    EXPECT_NEAR(st.y(), t, 1e-6f) << p.transpose();
}

TEST(UvMapping, ScalesAndShifts) {
    const Mapping2D plain = Make({});
    EXPECT_TRUE(Needs(plain) & kNeedsUv);
    EXPECT_EQ(Map(plain, At(0.25f, 0.5f)), Vec2f(0.25f, 0.5f));
    const Mapping2D mapping =
        Make({FloatParameter("uscale", {2}), FloatParameter("vscale", {-3}),
              FloatParameter("udelta", {10}), FloatParameter("vdelta", {20})});
    EXPECT_EQ(Map(mapping, At(0.25f, 0.5f)), Vec2f(10.5f, 18.5f));
}

TEST(SphericalMapping, GivesAnglesOverPi) {
    Mat4d shift = Mat4d::Identity();
    shift(0, 3) = 100;  // the inverse is applied, unlike for solid textures
    const Mapping2D mapping = Make({StringParameter("mapping", "spherical")}, shift);
    EXPECT_FALSE(Needs(mapping) & kNeedsUv);
    ExpectMap(mapping, {100, 0, 5}, 0, 0);
    ExpectMap(mapping, {103, 0, 0}, 0.5f, 0);
    ExpectMap(mapping, {100, 2, 0}, 0.5f, 0.25f);
    ExpectMap(mapping, {99, 0, 0}, 0.5f, 0.5f);
    ExpectMap(mapping, {100, -1, 0}, 0.5f, 0.75f);
    ExpectMap(mapping, {101, 1, -std::sqrt(2.f)}, 0.75f, 0.125f);
}

TEST(CylindricalMapping, GivesAngleAndHeightOfTheUnitDirection) {
    const Mapping2D mapping = Make({StringParameter("mapping", "cylindrical")});
    EXPECT_FALSE(Needs(mapping) & kNeedsUv);
    ExpectMap(mapping, {2, 0, 0}, 0.5f, 0);
    ExpectMap(mapping, {0, 2, 0}, 0.75f, 0);
    ExpectMap(mapping, {0, -3, 4}, 0.25f, 0.8f);
    ExpectMap(mapping, {-3, 0, -4}, 1, -0.8f);
}

TEST(PlanarMapping, ProjectsWorldPoints) {
    Mat4d shift = Mat4d::Identity();
    shift(0, 3) = 100;  // has no effect
    const Parameter planar = StringParameter("mapping", "planar");
    ExpectMap(Make({planar}, shift), {1, 2, 3}, 1, 2);
    ExpectMap(Make({planar, VectorParameter("v1", 0, 0, 2), VectorParameter("v2", 1, 1, 0),
                    FloatParameter("udelta", {0.5f}), FloatParameter("vdelta", {-1})}),
              {1, 2, 3}, 6.5f, 2);
}

TEST(Mapping, RefusesUnknownNames) {
    EXPECT_TRUE(Contains(ErrorOf([] { Make({StringParameter("mapping", "toroidal")}); }),
                         "scene.pbrt:10: texture mapping \"toroidal\""));
    const Mapping2D mapping =
        Make({StringParameter("mapping", "toroidal")}, Mat4d::Identity(), true);
    EXPECT_EQ(Map(mapping, At(0.25f, 0.5f)), Vec2f(0.25f, 0.5f));
}

}  // namespace
}  // namespace lull
