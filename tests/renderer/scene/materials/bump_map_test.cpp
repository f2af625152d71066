#include <gtest/gtest.h>

#include "tests/renderer/scene/materials/material_scene.h"

namespace lull::test {
namespace {

TEST(BumpMap, TiltsTheNormalByTheSlope) {
    MaterialScene b;
    b.AddChecks(false, 3, 1e-3f);  // 1e-3 high where the cells' numbers sum to even, else 0
    b.AddMaterial("matte", {Textured("bumpmap", 0, false)});
    const MaterialTable table = b.Make();
    // A step of 0.0005 in u moves p by 0.001 in y: across an edge only close to it.
    SurfaceInteraction hit = MaterialScene::Hit(0, Vec3f(0.5f, 0.9995f, 0.5f));
    table.MakeBsdf(b.textures, &hit);
    // dp/du = (0, 2, 0) + (0 - 1e-3) / 5e-4 (0, 0, 1), dp/dv as it was.
    EXPECT_TRUE(hit.dpdu.isApprox(Vec3f(0, 2, -2), 1e-3f)) << hit.dpdu.transpose();
    EXPECT_TRUE(hit.dpdv.isApprox(Vec3f(-2, 0, 0), 1e-3f));
    EXPECT_TRUE(hit.ns.isApprox(Vec3f(0, 1, 1).normalized(), 1e-3f)) << hit.ns.transpose();
    EXPECT_TRUE(hit.n == Vec3f::UnitZ());

    // On the other side of the surface the normal stays on that side, the slope turns.
    hit = MaterialScene::Hit(0, Vec3f(0.5f, 0.9995f, 0.5f));
    hit.n = hit.ns = -Vec3f::UnitZ();
    table.MakeBsdf(b.textures, &hit);
    EXPECT_TRUE(hit.ns.isApprox(Vec3f(0, 1, -1).normalized(), 1e-3f)) << hit.ns.transpose();

    hit = MaterialScene::Hit(0);
    table.MakeBsdf(b.textures, &hit);
    EXPECT_TRUE(hit.ns.isApprox(Vec3f::UnitZ()));
}

TEST(BumpMap, StepsByTheDistanceOfSamplesWhereItIsKnown) {
    MaterialScene b;
    b.AddChecks(false, 3, 1e-3f);
    b.AddMaterial("matte", {Textured("bumpmap", 0, false)});
    const MaterialTable table = b.Make();
    SurfaceInteraction hit = MaterialScene::Hit(0, Vec3f(0.5f, 0.985f, 0.5f));
    hit.duvdx = {0.01f, 0};
    hit.duvdy = {0.01f, -0.02f};
    table.MakeBsdf(b.textures, &hit);
    EXPECT_TRUE(hit.dpdu.isApprox(Vec3f(0, 2, -0.1f), 1e-3f)) << hit.dpdu.transpose();
}

TEST(BumpMap, OfAConstantUsesTheCurvature) {
    MaterialScene b;
    b.AddMaterial("matte", {Float("bumpmap", 0.5f)});
    const MaterialTable table = b.Make();
    SurfaceInteraction hit = MaterialScene::Hit(0);
    hit.dndu = Vec3f(0, 0, 2);
    table.MakeBsdf(b.textures, &hit);
    EXPECT_TRUE(hit.dpdu.isApprox(Vec3f(0, 2, 1), 1e-3f));
}

TEST(BumpMap, WithoutTangentsChangesNothing) {
    MaterialScene b;
    b.AddMaterial("matte", {Float("bumpmap", 0.5f)});
    const MaterialTable table = b.Make();
    SurfaceInteraction hit = MaterialScene::Hit(0);
    hit.dpdu = hit.dpdv = Vec3f::Zero();
    table.MakeBsdf(b.textures, &hit);
    EXPECT_TRUE(hit.ns == Vec3f::UnitZ());
}

// As in pbrt-v4, where the amount is a number, "share".
TEST(BumpMap, OfAMixIsThatOfTheMaterialShown) {
    MaterialScene b;
    b.AddMaterial("matte");
    b.AddMaterial("mirror", {Float("bumpmap", 0.5f)});
    MaterialEntity& mix = b.AddMaterial("mix", {Float("share", 0.75f)});
    mix.operands = {0, 1};
    const MaterialTable table = b.Make();
    EXPECT_EQ(table.Needs(2), table.Needs(1));
    int tilted = 0;
    for (int i = 0; i < 1000; ++i) {
        SurfaceInteraction hit = MaterialScene::Hit(2, Vec3f(0.5f, 0.001f * float(i), 0.5f));
        hit.dndu = Vec3f(0, 0, 2);
        const Bsdf bsdf = table.MakeBsdf(b.textures, &hit);
        ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 1);
        const bool isMatte = std::holds_alternative<LambertianReflection>(bsdf.At(0));
        EXPECT_EQ(hit.ns.isApprox(Vec3f::UnitZ()), isMatte);
        tilted += !isMatte;
    }
    EXPECT_NEAR(tilted, 250, 50);
}

}  // namespace
}  // namespace lull::test
