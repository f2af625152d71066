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

TEST(MapFootprint, SaysHowFarTheMappedPointMoves) {
    Mat4d place = Mat4d::Identity();
    place(0, 3) = 0.3;
    const auto kind = [](const char* name) { return StringParameter("mapping", name); };
    const Mapping2D mappings[] = {
        Make({FloatParameter("uscale", {2}), FloatParameter("vscale", {-3}),
              FloatParameter("udelta", {10})}),
        AffineUvMapping{{1, 2, 300}, {-3, 0.5f, 4}},
        Make({kind("planar"), VectorParameter("v1", 1, 2, 3), VectorParameter("v2", 0, -1, 4),
              FloatParameter("udelta", {1})}),
        Make({kind("spherical")}, place), Make({kind("cylindrical")}, place)};
    for (const Mapping2D& mapping : mappings) {
        TextureContext c{{0.7f, 0.5f, -0.4f}, {0.2f, 0.6f}};
        c.dpdx = {0.002f, 0.01f, -0.004f};
        c.dpdy = {0.01f, 0, 0.006f};
        c.duvdx = {0.003f, -0.002f};
        c.duvdy = {0.001f, 0.005f};
        const MappedFootprint f = MapFootprint(mapping, c);
        EXPECT_EQ(f.st, Map(mapping, c));
        TextureContext right = c, below = c;
        right.p += c.dpdx;
        right.uv += c.duvdx;
        below.p += c.dpdy;
        below.uv += c.duvdy;
        const float tolerance = 4e-4f;
        EXPECT_LT((Map(mapping, right) - f.st - f.dx).norm(), tolerance) << mapping.index();
        EXPECT_LT((Map(mapping, below) - f.st - f.dy).norm(), tolerance) << mapping.index();
        const MappedFootprint unknown = MapFootprint(mapping, TextureContext{c.p, c.uv});
        EXPECT_EQ(unknown.st, f.st);
        EXPECT_TRUE(unknown.dx.isZero(0) && unknown.dy.isZero(0));
    }
}

// As pbrt-v3 does it, which folds the difference after it has divided by the step.
TEST(MapFootprint, FoldsTheSeamOfAngles) {
    const Mapping2D mapping = Make({StringParameter("mapping", "spherical")});
    TextureContext c{{1, -1e-4f, 0}, {}};
    c.dpdx = {0, 0.1f, 0};
    const float jump = (Map(mapping, AtPoint({1, 0.0099f, 0})).y() - Map(mapping, c).y()) / 0.1f;
    ASSERT_LT(jump, -9);
    EXPECT_NEAR(MapFootprint(mapping, c).dx.y(), -(jump + 1), 1e-4f);
}

}  // namespace
}  // namespace lull
