// Checks what glTF's material is made of; its values are checked in bsdf/, its look in transport/.
#include <gtest/gtest.h>

#include "renderer/bsdf/layered_lobes.h"
#include "tests/renderer/bsdf/sphere_statistics.h"
#include "tests/renderer/scene/materials/material_scene.h"

namespace lull::test {
namespace {

// One material, of these factors.
struct SceneWith : MaterialScene {
    SceneWith(const std::map<std::string, float>& factors, bool solid = false) {
        MaterialEntity& m = AddMaterial("metallicroughness");
        m.parameters.Add(Color("basecolorfactor", Rgb(0.5f, 0.25f, 0)));
        for (const auto& [name, value] : factors) m.parameters.Add(Float(name, value));
        if (solid) m.parameters.Add(Bool("solid", true));
    }
};

TEST(MetallicRoughness, IsMetalByDefault) {
    SceneWith b({});
    const Bsdf bsdf = b.MakeBsdf(0);
    ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 1);
    const auto& lobe = LobeAt<LayeredReflection>(bsdf, 0);
    EXPECT_TRUE(IsBlack(lobe.diffuse));
    EXPECT_FLOAT_EQ(lobe.f0.r, 0.5f);
    EXPECT_FLOAT_EQ(lobe.f90, 1);
    EXPECT_FLOAT_EQ(lobe.alpha, 1);
    EXPECT_TRUE(b.messages.empty());
}

TEST(MetallicRoughness, SquaresRoughness) {
    EXPECT_FLOAT_EQ(
        LobeAt<LayeredReflection>(SceneWith({{"roughnessfactor", 0.3f}}).MakeBsdf(0), 0).alpha,
        0.09f);
}

TEST(MetallicRoughness, ReflectsAsMirrorWhereSmooth) {
    const Bsdf metal = SceneWith({{"roughnessfactor", 0}}).MakeBsdf(0);
    ASSERT_EQ(metal.LobeCount(LobeSet::All), 1);
    const auto& mirror = LobeAt<ThinSpecular>(metal, 0);
    EXPECT_FLOAT_EQ(mirror.f0.g, 0.25f);
    EXPECT_FLOAT_EQ(mirror.f90, 1);
    EXPECT_TRUE(IsBlack(mirror.t));

    const Bsdf varnish = SceneWith({{"metallicfactor", 0}, {"roughnessfactor", 0}}).MakeBsdf(0);
    ASSERT_EQ(varnish.LobeCount(LobeSet::All), 2);
    EXPECT_NEAR(LobeAt<ThinSpecular>(varnish, 0).f0.r, 0.04f, 1e-6);
    const auto& base = LobeAt<LayeredReflection>(varnish, 1);
    EXPECT_TRUE(IsBlack(base.f0));
    EXPECT_EQ(base.f90, 0);
    EXPECT_GT(base.diffuse.r, 0.5f);  // divided by what is below the interface

    const Bsdf coated = SceneWith({{"clearcoatfactor", 1}}).MakeBsdf(0);
    ASSERT_EQ(coated.LobeCount(LobeSet::All), 2);
    EXPECT_NEAR(LobeAt<ThinSpecular>(coated, 1).f0.r, 0.04f, 1e-6);
    EXPECT_FLOAT_EQ(LobeAt<ThinSpecular>(coated, 1).f90, 1);
}

// As narrow as lamps without size allow, instead of a mirror that does not show them.
TEST(MetallicRoughness, KeepsHighlightsOnCoatsThatAreNearlySmooth) {
    const Bsdf coated =
        SceneWith({{"clearcoatfactor", 1}, {"clearcoatroughnessfactor", 0.03f}}).MakeBsdf(0);
    ASSERT_EQ(coated.LobeCount(LobeSet::All), 2);
    EXPECT_FLOAT_EQ(LobeAt<MicrofacetReflection<SchlickInterface>>(coated, 1).distribution.AlphaX(),
                    1e-3f);
}

TEST(MetallicRoughness, WithoutHighlightsIsLambertian) {
    const Bsdf bsdf = SceneWith({{"metallicfactor", 0}, {"specularfactor", 0}}).MakeBsdf(0);
    ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 1);
    EXPECT_FLOAT_EQ(LobeAt<LambertianReflection>(bsdf, 0).r.r, 0.5f);
}

TEST(MetallicRoughness, ScattersToTheOtherSide) {
    SceneWith b(
        {{"metallicfactor", 0}, {"specularfactor", 0}, {"diffusetransmissionfactor", 0.25f}});
    const Bsdf bsdf = b.MakeBsdf(0);
    ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 2);
    EXPECT_FLOAT_EQ(LobeAt<LambertianReflection>(bsdf, 0).r.r, 0.375f);
    EXPECT_FLOAT_EQ(LobeAt<LambertianTransmission>(bsdf, 1).t.r, 0.25f);  // white by default
}

// A white base reflects and transmits what the interface above leaves: in all, all light.
TEST(MetallicRoughness, TransmitsWhatTheInterfaceLeaves) {
    for (const float roughness : {0.f, 0.5f, 1.f})
        for (const double angle : {0., 60., 80., 88.}) {
            SceneWith b({{"metallicfactor", 0},
                         {"roughnessfactor", roughness},
                         {"diffusetransmissionfactor", 1}});
            SurfaceInteraction hit = MaterialScene::Hit(0);
            hit.wo = FromAngles(angle);
            const Bsdf bsdf = b.MakeBsdf(hit);
            ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 2);
            const GgxAlbedo reflected = DirectionalAlbedo(hit.wo.z(), Sqr(roughness));
            EXPECT_NEAR(LobeAt<LambertianTransmission>(bsdf, 1).t.r + reflected(0.04f, 1), 1, 1e-3)
                << roughness << " " << angle;
        }
}

TEST(MetallicRoughness, TakesItsInterfaceFromTheIndex) {
    const Bsdf bsdf = SceneWith({{"metallicfactor", 0}, {"ior", 2}}).MakeBsdf(0);
    EXPECT_NEAR(LobeAt<LayeredReflection>(bsdf, 0).f0.r, 1 / 9., 1e-6);
    const Bsdf half =
        SceneWith({{"metallicfactor", 0}, {"ior", 2}, {"specularfactor", 0.5f}}).MakeBsdf(0);
    EXPECT_NEAR(LobeAt<LayeredReflection>(half, 0).f0.r, 0.5 / 9., 1e-6);
    EXPECT_FLOAT_EQ(LobeAt<LayeredReflection>(half, 0).f90, 0.5f);
    SceneWith bad({{"ior", 0.5f}});
    EXPECT_THROW(bad.Make(), Error);
}

// The base of Blender 3's Principled BSDF is Disney's, with the surface's roughness.
TEST(MetallicRoughness, AddsTheInterfaceWhereAskedTo) {
    SceneWith b({{"metallicfactor", 0}, {"roughnessfactor", 0.7f}, {"clearcoatfactor", 1}});
    b.description.materials[0].parameters.Add(Bool("addedinterface", true));
    const Bsdf bsdf = b.MakeBsdf(0);
    ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 3);
    const auto& interface =
        LobeAt<MicrofacetReflection<StretchedInterface, SeparableMasking>>(bsdf, 0).interface;
    for (const float cosine : {1.f, 0.7f, 0.2f, 0.01f})
        EXPECT_NEAR(interface(cosine).x(), FresnelDielectric(cosine, 1.5f), 1e-5);
    const auto& base = LobeAt<DisneyDiffuse>(bsdf, 1);
    EXPECT_EQ(base.part, DisneyDiffuse::Part::Whole);
    EXPECT_FLOAT_EQ(base.roughness, 0.7f);
    EXPECT_FLOAT_EQ(base.r.r, 0.5f);
}

// Blender's Glossy BSDF, over a Diffuse one: as much from all directions.
TEST(MetallicRoughness, ReflectsEvenlyWhereAskedTo) {
    SceneWith b({{"roughnessfactor", 0.7f}, {"metallicfactor", 0.5f}, {"specularfactor", 0}});
    b.description.materials[0].parameters.Add(Bool("eveninterface", true));
    Bsdf bsdf = b.MakeBsdf(0);
    ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 2);
    const auto& lobe = LobeAt<MicrofacetReflection<CoatedInterface>>(bsdf, 0);
    for (const float cosine : {1.f, 0.2f, 0.01f})
        EXPECT_FLOAT_EQ((Rgb(lobe.r) * lobe.interface(cosine)).y(), 0.125f);
    EXPECT_FLOAT_EQ(LobeAt<LambertianReflection>(bsdf, 1).r.r, 0.25f);
    b.description.materials[0].parameters.Add(Bool("addedinterface", true));
    bsdf = b.MakeBsdf(0);
    const auto& old = LobeAt<MicrofacetReflection<StretchedInterface, SeparableMasking>>(bsdf, 0);
    for (const float cosine : {1.f, 0.2f, 0.01f})
        EXPECT_FLOAT_EQ(old.interface(cosine).y(), 0.125f);
}

// So does light that enters and leaves it again.
TEST(MetallicRoughness, KeepsRadianceInGlassWhereAskedTo) {
    SceneWith b({{"metallicfactor", 0}, {"transmissionfactor", 1}, {"roughnessfactor", 0}}, true);
    b.description.materials[0].parameters.Add(Bool("keepsradiance", true));
    SurfaceInteraction hit = MaterialScene::Hit(0);
    for (const float side : {1.f, -1.f}) {
        hit.wo = Vec3f(0, 0, side);
        const Bsdf bsdf = b.MakeBsdf(hit);
        EXPECT_FLOAT_EQ(bsdf.Eta(), 1);
        EXPECT_FLOAT_EQ(LobeAt<FresnelSpecular>(bsdf, 0).t.r,
                        0.5f * (side > 0 ? Sqr(1.5f) : 1 / Sqr(1.5f)));
    }
}

TEST(MetallicRoughness, TransmitsAsSheetOrSolid) {
    const std::map<std::string, float> smooth = {
        {"metallicfactor", 0}, {"transmissionfactor", 1}, {"roughnessfactor", 0}};
    std::map<std::string, float> rough = smooth;
    rough["roughnessfactor"] = 0.5f;
    const auto lastOf = [](const Bsdf& bsdf) { return bsdf.At(bsdf.LobeCount(LobeSet::All) - 1); };
    EXPECT_TRUE(std::holds_alternative<ThinSpecular>(lastOf(SceneWith(smooth).MakeBsdf(0))));
    EXPECT_TRUE(std::holds_alternative<ThinTransmission>(lastOf(SceneWith(rough).MakeBsdf(0))));
    const Bsdf glass = SceneWith(smooth, true).MakeBsdf(0);
    ASSERT_EQ(glass.LobeCount(LobeSet::All), 1);
    EXPECT_FLOAT_EQ(LobeAt<FresnelSpecular>(glass, 0).eta, 1.5f);
    EXPECT_FLOAT_EQ(glass.Eta(), 1.5f);
    EXPECT_TRUE(
        std::holds_alternative<MicrofacetTransmission>(lastOf(SceneWith(rough, true).MakeBsdf(0))));
}

// By interpolated normals, too, no light comes from behind.
TEST(MetallicRoughness, ReflectsNothingIntoTheSurface) {
    for (const float roughness : {0.f, 0.05f, 0.2f}) {
        SceneWith b({{"roughnessfactor", roughness}});
        SurfaceInteraction hit = MaterialScene::Hit(0);
        hit.ns = Vec3f(-0.766f, 0, 0.643f).normalized();
        hit.wo = Vec3f(0.94f, 0, 0.342f).normalized();
        const Bsdf bsdf = b.MakeBsdf(hit);
        Random random(7);
        int count = 0;
        for (int i = 0; i < 500; ++i) {
            const auto sample = bsdf.Sample(hit.wo, random.Point(), LobeSet::All);
            if (!sample) continue;
            EXPECT_GT(sample->wi.dot(hit.n), 0) << roughness;
            ++count;
        }
        EXPECT_GT(count, 490) << roughness;
    }
}

// What the sheen reflects at the angle of view is taken from what is below; the coat is above both.
TEST(MetallicRoughness, LaysSheenOverTheRest) {
    const std::map<std::string, float> factors = {
        {"metallicfactor", 0}, {"specularfactor", 0}, {"sheenroughnessfactor", 0.5f}};
    const auto make = [](SceneWith b, const Vec3f& wo) {
        b.description.materials[0].parameters.Add(Color("sheencolorfactor", Rgb(0.25f, 0.5f, 1)));
        SurfaceInteraction hit = MaterialScene::Hit(0);
        hit.wo = wo;
        return b.MakeBsdf(hit);
    };
    for (const Vec3f& wo : {Vec3f(0, 0, 1), Vec3f(0.8f, 0, 0.6f), Vec3f(0.99f, 0, 0.14107f)}) {
        const Bsdf bsdf = make(SceneWith(factors), wo);
        ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 2);
        const auto& sheen = LobeAt<CharlieSheen>(bsdf, 1);
        EXPECT_FLOAT_EQ(sheen.alpha, 0.25f);
        EXPECT_FLOAT_EQ(sheen.r.g, 0.5f);
        EXPECT_FLOAT_EQ(LobeAt<LambertianReflection>(bsdf, 0).r.r,
                        0.5f * (1 - SheenAlbedo(wo.z(), 0.25f)));
    }
    std::map<std::string, float> coated = factors;
    coated["clearcoatfactor"] = 1;
    const Bsdf bsdf = make(SceneWith(coated), Vec3f::UnitZ());
    ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 3);
    EXPECT_NEAR(LobeAt<CharlieSheen>(bsdf, 1).r.g, 0.5 * 0.96, 1e-5);
    // However narrow, it reflects no more than all light.
    std::map<std::string, float> narrow = factors;
    narrow["sheenroughnessfactor"] = 0;
    const Vec3f grazing(std::sqrt(1 - 1e-6f), 0, 1e-3f);
    const auto& rim = LobeAt<CharlieSheen>(make(SceneWith(narrow), grazing), 1);
    EXPECT_FLOAT_EQ(rim.r.b * SheenAlbedo(1e-3f, rim.alpha), 1);
    EXPECT_GT(SheenAlbedo(1e-3f, rim.alpha), 1.5f);
}

// Rougher along the tangent, which may be turned; the base below is as it was.
TEST(MetallicRoughness, IsAnisotropicAlongItsTangent) {
    const std::map<std::string, float> factors = {
        {"metallicfactor", 0.5f}, {"roughnessfactor", 0.5f}, {"anisotropyfactor", 0.6f}};
    const auto axisOf = [](SceneWith b, float side) {
        const MaterialTable table = b.Make();
        EXPECT_EQ(table.Needs(0), kNeedsTangents);
        SurfaceInteraction hit = MaterialScene::Hit(0);
        hit.dpdv *= side;
        const Bsdf bsdf = table.MakeBsdf(b.textures, &hit);
        EXPECT_EQ(bsdf.LobeCount(LobeSet::All), 2);
        const auto& d = LobeAt<MicrofacetReflection<CoatedInterface>>(bsdf, 0).distribution;
        EXPECT_FLOAT_EQ(d.AlphaX(), Lerp(0.36f, 0.25f, 1));
        EXPECT_FLOAT_EQ(d.AlphaY(), 0.25f);
        EXPECT_FALSE(IsBlack(LobeAt<LayeredReflection>(bsdf, 1).diffuse));
        return bsdf.Shading().s;
    };
    EXPECT_TRUE(axisOf(SceneWith(factors), 1).isApprox(Vec3f(0, 1, 0)));
    std::map<std::string, float> turned = factors;
    turned["anisotropyrotation"] = kPi / 3;
    const float c = 0.5f, s = std::sqrt(0.75f);
    EXPECT_TRUE(axisOf(SceneWith(turned), 1).isApprox(Vec3f(-s, c, 0)));
    EXPECT_TRUE(axisOf(SceneWith(turned), -1).isApprox(Vec3f(s, c, 0)));
}

TEST(MetallicRoughness, MultipliesVertexColours) {
    SceneWith b({});
    b.description.materials[0].parameters.Add(Bool("vertexcolors", true));
    const MaterialTable table = b.Make();
    EXPECT_EQ(table.Needs(0), kNeedsColor);
    SurfaceInteraction hit = MaterialScene::Hit(0);
    hit.color = Rgb(0.5f, 1, 1);
    EXPECT_FLOAT_EQ(LobeAt<LayeredReflection>(table.MakeBsdf(b.textures, &hit), 0).f0.r, 0.25f);
}

TEST(NormalMap, IsAskedForByMaterialsThatHaveOneAlone) {
    SceneWith b({});
    EXPECT_EQ(b.Make().Needs(0), kNeedsNothing);
    b.AddChecks(true, 2);
    b.description.materials[0].parameters.Add(Textured("normalmap", 0, true));
    EXPECT_EQ(b.Make().Needs(0), kNeedsTangents | kNeedsUv);
}

}  // namespace
}  // namespace lull::test
