// Checks mixtures, refusals and what materials ask of a hit.
#include <gtest/gtest.h>

#include "tests/renderer/scene/materials/material_scene.h"

namespace lull::test {
namespace {

// Colours of 0 to 255, for instance.
TEST(Material, WarnsOfMoreLightThanItReceives) {
    const char* const kind =
        "number outside of 0 to 1: the surface can return more light than it receives, as in "
        "pbrt-v3";
    struct Case {
        const char* material;
        Parameter parameter;
        int warnings;
    };
    for (const Case& c :
         {Case{"matte", Grey("Kd", 1.000005f), 0}, Case{"matte", Color("Kd", {-0.1f, 1, 1}), 0},
          Case{"matte", Color("Kd", {0.5f, 128, 0}), 1}, Case{"mirror", Grey("Kr", 1.5f), 1},
          Case{"uber", Grey("opacity", 2), 1}, Case{"disney", Float("metallic", 1), 0},
          Case{"disney", Float("metallic", -1), 1}, Case{"disney", Float("spectrans", 2), 1},
          Case{"disney", Float("difftrans", 2), 0}, Case{"metal", Grey("k", 9), 0}}) {
        MaterialScene b;
        b.AddMaterial(c.material, {c.parameter});
        b.Make();
        EXPECT_EQ(b.warnings.Total(), c.warnings) << c.material << " " << c.parameter.name;
        EXPECT_EQ(b.warnings.Counts().count(kind), size_t(c.warnings));
    }
}

const std::string kStandsIn = "; with --substitute a matte material stands in";

TEST(Mix, ScalesTheLobesOfBoth) {
    MaterialScene b;
    b.AddMaterial("glass");
    b.AddMaterial("plastic");
    MaterialEntity& m = b.AddMaterial("mix");
    m.operands = {0, 1};
    m.parameters.Add(Color("amount", Rgb(0.25f, 0.5f, 1)));
    const Bsdf bsdf = b.MakeBsdf(2);
    ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 3);
    EXPECT_TRUE((Rgb(LobeAt<FresnelSpecular>(bsdf, 0).t) == Rgb(0.25f, 0.5f, 1)).all());
    // Black parts count as lobes all the same.
    EXPECT_TRUE(
        (Rgb(LobeAt<LambertianReflection>(bsdf, 1).r) == 0.25f * Rgb(0.75f, 0.5f, 0)).all());
    EXPECT_EQ(bsdf.Eta(), 1.5f);
}

TEST(Mix, TakesIndexFromTheFirst) {
    MaterialScene b;
    b.AddMaterial("glass");
    b.AddMaterial("matte");
    b.AddMaterial("mix").operands = {1, 0};
    EXPECT_EQ(b.MakeBsdf(2).Eta(), 1);
}

TEST(Mix, NestsAndKeepsScale) {
    MaterialScene b;
    b.AddMaterial("substrate");
    b.AddMaterial("mix").operands = {0, 0};
    b.AddMaterial("mix").operands = {1, 0};
    const Bsdf bsdf = b.MakeBsdf(2);
    ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 3);
    ExpectGrey(LobeAt<FresnelBlend>(bsdf, 0).scale, 0.25f);
    ExpectGrey(LobeAt<FresnelBlend>(bsdf, 1).scale, 0.25f);
    ExpectGrey(LobeAt<FresnelBlend>(bsdf, 2).scale, 0.5f);
}

TEST(Mix, OfTexturesIsTheSameAsFolded) {
    MaterialScene b;
    b.AddChecks(true, 3);
    b.AddMaterial("matte");
    b.AddMaterial("plastic");
    MaterialEntity& m = b.AddMaterial("mix");
    m.operands = {0, 1};
    m.parameters.Add(Textured("amount", 0, true));
    const Bsdf even = b.MakeBsdf(2, Vec3f(0.5f, 0.5f, 0.5f));
    const Bsdf odd = b.MakeBsdf(2, Vec3f(1.5f, 0.5f, 0.5f));
    ASSERT_EQ(even.LobeCount(LobeSet::All), 3);
    ASSERT_EQ(odd.LobeCount(LobeSet::All), 3);
    ExpectGrey(LobeAt<LambertianReflection>(even, 0).r, 0.5f);
    ExpectGrey(LobeAt<LambertianReflection>(even, 1).r, 0);
    ExpectGrey(LobeAt<LambertianReflection>(odd, 0).r, 0);
    ExpectGrey(LobeAt<LambertianReflection>(odd, 1).r, 0.25f);
}

TEST(Mix, RefusesMoreThanEightLobes) {
    MaterialScene b;
    b.AddMaterial("translucent");
    b.AddMaterial("mix").operands = {0, 0};
    EXPECT_EQ(ErrorOf(&b), "");
    b.AddMaterial("mix").operands = {1, 0};
    EXPECT_EQ(ErrorOf(&b),
              "scene.pbrt:30: material \"mix\" can have more than 8 lobes" + kStandsIn);
}

TEST(Mix, RefusesUnknownOperands) {
    MaterialScene b;
    b.AddMaterial("matte");
    MaterialEntity& m = b.AddMaterial("mix");
    m.operands = {0, -1};
    m.parameters.Add(String("namedmaterial2", "gold"));
    EXPECT_EQ(
        ErrorOf(&b),
        "scene.pbrt:20: \"namedmaterial2\" of a mix: there is no material \"gold\"" + kStandsIn);
}

TEST(Materials, UnknownKindsAreRefused) {
    for (const char* kind : {"velvet", "kd subsurface", "Matte"}) {
        MaterialScene b;
        b.AddMaterial("matte");
        b.AddMaterial(kind);
        EXPECT_EQ(ErrorOf(&b), "scene.pbrt:20: material \"" + std::string(kind) +
                                   "\" is not supported" + kStandsIn);
    }
}

TEST(Materials, SubstitutionIsCounted) {
    MaterialScene b(true);
    b.AddMaterial("velvet", {Float("beta_m", 0.3f)});
    b.AddMaterial("velvet", {Grey("Kd", 0.2f)});
    b.AddMaterial("silk");
    const MaterialTable table = b.Make();
    EXPECT_EQ(b.warnings.Total(), 3);
    ASSERT_EQ(b.messages.size(), 2u);
    EXPECT_EQ(b.messages[0],
              "scene.pbrt:10: warning: material \"velvet\" is not supported; a matte material "
              "stands in");
    SurfaceInteraction hit = MaterialScene::Hit(0);
    ExpectGrey(LobeAt<LambertianReflection>(table.MakeBsdf(b.textures, &hit), 0).r, 0.5f);
    hit = MaterialScene::Hit(1);
    ExpectGrey(LobeAt<LambertianReflection>(table.MakeBsdf(b.textures, &hit), 0).r, 0.2f);
}

TEST(Materials, SubsurfaceIsChecked) {
    const auto error = [](const char* kind, const char* name, float value) {
        MaterialScene b;
        b.AddMaterial(kind, {Float(name, value)});
        return ErrorOf(&b);
    };
    EXPECT_EQ(error("subsurface", "eta", 0.5f),
              "scene.pbrt:10: \"eta\" of material \"subsurface\" has to lie between 1 and 4, "
              "\"g\" between -0.99 and 0.99; they are 0.5 and 0" +
                  kStandsIn);
    EXPECT_HAS(error("kdsubsurface", "g", 1), "they are 1.33 and 1");
    EXPECT_EQ(error("kdsubsurface", "scale", -1),
              "scene.pbrt:10: \"scale\" of material \"kdsubsurface\" is -1; it cannot be negative" +
                  kStandsIn);
    MaterialScene b;
    b.AddMaterial("matte");
    b.AddMaterial("subsurface");
    MaterialEntity& mix = b.AddMaterial("mix");
    mix.operands = {0, 1};
    EXPECT_HAS(ErrorOf(&b), "scene.pbrt:30: a mix with a material that scatters below");
}

TEST(Materials, UnusedParametersAreReported) {
    MaterialScene b;
    MaterialEntity& m = b.AddMaterial("matte", {Float("roughness", 0.1f)});
    m.parameters.Add(String("type", "matte"));
    b.Make();
    ASSERT_EQ(b.messages.size(), 1u);
    EXPECT_HAS(b.messages[0], "scene.pbrt:7");
    EXPECT_HAS(b.messages[0], "roughness");
}

TEST(Materials, AskOnlyForWhatTheyNeed) {
    MaterialScene b;
    b.AddChecks(true, 2);
    b.AddChecks(true, 3);
    b.AddChecks(false, 2);
    b.AddChecks(false, 3);
    b.AddMaterial("matte");
    b.AddMaterial("matte", {Textured("Kd", 0, true)});
    b.AddMaterial("matte", {Textured("Kd", 1, true)});
    b.AddMaterial("metal", {Float("uroughness", 0.3f)});
    b.AddMaterial("metal", {Textured("roughness", 2, false)});
    b.AddMaterial("matte", {Textured("bumpmap", 2, false)});
    b.AddMaterial("matte", {Textured("bumpmap", 3, false)});
    b.AddMaterial("mix").operands = {6, 1};
    b.AddMaterial("mix").operands = {1, 6};
    b.AddMaterial("matte", {Float("bumpmap", 0)});
    const MaterialTable table = b.Make();
    const int bump = kNeedsTangents | kNeedsNormalDerivatives | kNeedsFootprint;
    const int expected[] = {kNeedsNothing, kNeedsUv,        kNeedsNothing, kNeedsTangents,
                            kNeedsUv,      bump | kNeedsUv, bump,          bump | kNeedsUv,
                            kNeedsUv,      kNeedsNothing};
    for (int i = 0; i < int(std::size(expected)); ++i)
        EXPECT_EQ(int(table.Needs(i)), expected[i]) << i;
}

TEST(Materials, AnisotropyFollowsTheTangent) {
    MaterialScene b;
    b.AddMaterial("metal", {Float("uroughness", 0.3f)});
    const MaterialTable table = b.Make();
    SurfaceInteraction hit = MaterialScene::Hit(0);
    hit.ns = Vec3f(0, 0.6f, 0.8f);
    const Frame frame = table.MakeBsdf(b.textures, &hit).Shading();
    EXPECT_TRUE(frame.s.isApprox(Vec3f(0, 0.8f, -0.6f), 1e-6f));
    EXPECT_TRUE(frame.t.isApprox(frame.n.cross(frame.s)));
    // Without a tangent any frame does.
    hit.dpdu = hit.ns * 3;
    const Frame any = table.MakeBsdf(b.textures, &hit).Shading();
    EXPECT_NEAR(any.s.norm(), 1, 1e-6f);
    EXPECT_NEAR(any.s.dot(any.n), 0, 1e-6f);
}

// Returns a hit as the material's bump map leaves it: of texture 0, 1e-3 high where the cells'
// numbers sum to even, else 0, or a constant.
SurfaceInteraction Bumped(SurfaceInteraction hit,
                          const Parameter& map = Textured("bumpmap", 0, false)) {
    MaterialScene b;
    b.AddChecks(false, 3, 1e-3f);
    b.AddMaterial("matte", {map});
    b.MakeBsdf(&hit);
    return hit;
}

TEST(BumpMap, TiltsTheNormalByTheSlope) {
    // A step of 0.0005 in u moves p by 0.001 in y: across an edge only close to it.
    SurfaceInteraction hit = Bumped(MaterialScene::Hit(0, Vec3f(0.5f, 0.9995f, 0.5f)));
    // dp/du = (0, 2, 0) + (0 - 1e-3) / 5e-4 (0, 0, 1), dp/dv as it was.
    EXPECT_TRUE(hit.dpdu.isApprox(Vec3f(0, 2, -2), 1e-3f)) << hit.dpdu.transpose();
    EXPECT_TRUE(hit.dpdv.isApprox(Vec3f(-2, 0, 0), 1e-3f));
    EXPECT_TRUE(hit.ns.isApprox(Vec3f(0, 1, 1).normalized(), 1e-3f)) << hit.ns.transpose();
    EXPECT_TRUE(hit.n == Vec3f::UnitZ());

    // On the other side of the surface the normal stays on that side, the slope turns.
    hit = MaterialScene::Hit(0, Vec3f(0.5f, 0.9995f, 0.5f));
    hit.n = hit.ns = -Vec3f::UnitZ();
    hit = Bumped(hit);
    EXPECT_TRUE(hit.ns.isApprox(Vec3f(0, 1, -1).normalized(), 1e-3f)) << hit.ns.transpose();
    EXPECT_TRUE(Bumped(MaterialScene::Hit(0)).ns.isApprox(Vec3f::UnitZ()));
}

TEST(BumpMap, StepsByTheDistanceOfSamplesWhereItIsKnown) {
    SurfaceInteraction hit = MaterialScene::Hit(0, Vec3f(0.5f, 0.985f, 0.5f));
    hit.duvdx = {0.01f, 0};
    hit.duvdy = {0.01f, -0.02f};
    hit = Bumped(hit);
    EXPECT_TRUE(hit.dpdu.isApprox(Vec3f(0, 2, -0.1f), 1e-3f)) << hit.dpdu.transpose();
}

TEST(BumpMap, OfAConstantUsesTheCurvatureAndTangents) {
    SurfaceInteraction hit = MaterialScene::Hit(0);
    hit.dndu = Vec3f(0, 0, 2);
    EXPECT_TRUE(Bumped(hit, Float("bumpmap", 0.5f)).dpdu.isApprox(Vec3f(0, 2, 1), 1e-3f));
    hit = MaterialScene::Hit(0);
    hit.dpdu = hit.dpdv = Vec3f::Zero();
    EXPECT_TRUE(Bumped(hit, Float("bumpmap", 0.5f)).ns == Vec3f::UnitZ());
}

// As in pbrt-v4, where the amount is a number, "share". A mix within a mix makes a choice of its
// own.
TEST(BumpMap, OfAMixIsThatOfTheMaterialShown) {
    MaterialScene b;
    b.AddMaterial("matte");
    b.AddMaterial("mirror", {Float("bumpmap", 0.5f)});
    b.AddMaterial("mix", {Float("share", 0.75f)}).operands = {0, 1};
    b.AddMaterial("mix", {Float("share", 0.5f)}).operands = {0, 1};
    b.AddMaterial("mix", {Float("share", 0.5f)}).operands = {3, 0};
    const MaterialTable table = b.Make();
    EXPECT_EQ(table.Needs(2), table.Needs(1));
    for (const int mix : {2, 4}) {
        int tilted = 0;
        for (int i = 0; i < 1000; ++i) {
            SurfaceInteraction hit = MaterialScene::Hit(mix, Vec3f(0.5f, 0.001f * float(i), 0.5f));
            hit.dndu = Vec3f(0, 0, 2);
            const Bsdf bsdf = table.MakeBsdf(b.textures, &hit);
            ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 1);
            const bool isMatte = std::holds_alternative<LambertianReflection>(bsdf.At(0));
            EXPECT_EQ(hit.ns.isApprox(Vec3f::UnitZ()), isMatte);
            tilted += !isMatte;
        }
        EXPECT_NEAR(tilted, 250, 50) << mix;
    }
}

}  // namespace

}  // namespace lull::test
