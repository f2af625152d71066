// Checks parameters, defaults and lobes of each kind of material.
#include <gtest/gtest.h>

#include "renderer/bsdf/subsurface.h"
#include "renderer/input/spectrum.h"
#include "tests/renderer/files/test_files.h"
#include "tests/renderer/scene/materials/material_scene.h"

namespace lull::test {
namespace {

// Makes the Bsdf of a material, which has so many lobes, and no warning.
Bsdf BsdfOf(const std::string& kind, int lobes, const std::vector<Parameter>& parameters = {}) {
    MaterialScene b;
    b.AddMaterial(kind, parameters);
    Bsdf bsdf = b.MakeBsdf(0);
    EXPECT_EQ(bsdf.LobeCount(LobeSet::All), lobes) << kind;
    EXPECT_EQ(b.messages, std::vector<std::string>()) << kind;
    return bsdf;
}

TEST(Matte, Defaults) {
    const Bsdf bsdf = BsdfOf("matte", 1);
    ExpectGrey(LobeAt<LambertianReflection>(bsdf, 0).r, 0.5f);
    EXPECT_EQ(bsdf.Eta(), 1);
}

TEST(Matte, SigmaMakesItRough) {
    const auto rough = LobeAt<OrenNayar>(BsdfOf("matte", 1, {Float("sigma", 200)}), 0);
    const OrenNayar clamped(Rgb::Constant(0.5f), 90);
    EXPECT_FLOAT_EQ(rough.a, clamped.a);
    EXPECT_FLOAT_EQ(rough.b, clamped.b);
}

TEST(Matte, BlackHasNoLobe) { BsdfOf("matte", 0, {Color("Kd", Rgb(0, -1, 0))}); }

TEST(Subsurface, Defaults) {
    for (const char* kind : {"subsurface", "kdsubsurface"}) {
        const Bsdf bsdf = BsdfOf(kind, 1);
        EXPECT_EQ(LobeAt<FresnelSpecular>(bsdf, 0).eta, 1.33f);
        EXPECT_EQ(bsdf.Eta(), 1.33f);
    }
}

// The profile that parameters make is that of the coefficients which they stand for.
TEST(Subsurface, Parameters) {
    MaterialScene b;
    // Measured coefficients are reduced ones: g does not count.
    b.AddMaterial("subsurface", {String("name", "Marble"), Float("scale", 2), Float("g", 0.5f)});
    b.AddMaterial("subsurface", {Color("sigma_a", Rgb(0.0021f, 0.0041f, 0.0071f)),
                                 Color("sigma_s", Rgb(2.19f, 2.62f, 3.00f)), Float("scale", 2)});
    b.AddMaterial("kdsubsurface",
                  {Color("Kd", Rgb(0.2f, 0.4f, 0.6f)), Color("mfp", Rgb(1, 2, 0.5f))});
    const MaterialTable table = b.Make();
    EXPECT_TRUE(b.messages.empty());
    const auto profile = [&](int i) { return *table.Profile(b.textures, MaterialScene::Hit(i)); };
    for (const float r : {0.01f, 0.1f, 0.5f, 2.f})
        EXPECT_TRUE(profile(0)(r).isApprox(profile(1)(r), 1e-5f)) << r;
    const DiffusionTable tabulated(0, 1.33f);
    Rgb albedo;
    for (int c = 0; c < 3; ++c) albedo[c] = AlbedoOfScattering(tabulated, 0.2f * float(c + 1));
    const Rgb sigmaT(1, 0.5f, 2);
    const DiffusionProfile expected(tabulated, (1 - albedo) * sigmaT, albedo * sigmaT);
    for (const float r : {0.01f, 0.1f, 0.5f, 2.f})
        EXPECT_TRUE(profile(2)(r).isApprox(expected(r), 1e-5f)) << r;
}

TEST(Subsurface, UnknownNamesAreWarnedOf) {
    MaterialScene b;
    b.AddMaterial("subsurface", {String("name", "Marbel")});
    b.Make();
    ASSERT_EQ(b.messages.size(), 1u);
    EXPECT_HAS(b.messages[0], "Marbel");
}

TEST(Plastic, Defaults) {
    const Bsdf bsdf = BsdfOf("plastic", 2);
    ExpectGrey(LobeAt<LambertianReflection>(bsdf, 0).r, 0.25f);
    const auto& coat = LobeAt<DielectricReflection>(bsdf, 1);
    ExpectGrey(coat.r, 0.25f);
    EXPECT_FLOAT_EQ(coat.interface.eta, 1 / 1.5f);  // the dense side outside, as pbrt-v3
    EXPECT_NEAR(coat.distribution.AlphaX(), RoughnessToAlpha(0.1f), 1e-5f);
    EXPECT_NEAR(coat.distribution.AlphaY(), RoughnessToAlpha(0.1f), 1e-5f);
    EXPECT_EQ(bsdf.Eta(), 1);
}

TEST(Plastic, RemapsRoughnessUnlessTold) {
    const Bsdf bsdf =
        BsdfOf("plastic", 2, {Float("roughness", 0.3f), Bool("remaproughness", false)});
    EXPECT_FLOAT_EQ(LobeAt<DielectricReflection>(bsdf, 1).distribution.AlphaX(), 0.3f);
}

TEST(Metal, Defaults) {
    const Bsdf bsdf = BsdfOf("metal", 1);
    const auto& metal = LobeAt<ConductorReflection>(bsdf, 0);
    ExpectGrey(metal.r, 1);
    EXPECT_NEAR(metal.distribution.AlphaX(), RoughnessToAlpha(0.01f), 1e-5f);
    const ConductorInterface copper(CopperEta(), CopperK());
    EXPECT_TRUE((metal.interface(0.7f) == copper(0.7f)).all());
    // Copper is red.
    EXPECT_GT(metal.interface(1).x(), metal.interface(1).z() + 0.2f);
}

TEST(Metal, RoughnessOfEachTangent) {
    const Bsdf bsdf = BsdfOf(
        "metal", 1,
        {Float("roughness", 0.2f), Float("vroughness", 0.4f), Bool("remaproughness", false)});
    const auto& d = LobeAt<ConductorReflection>(bsdf, 0).distribution;
    EXPECT_FLOAT_EQ(d.AlphaX(), 0.2f);
    EXPECT_FLOAT_EQ(d.AlphaY(), 0.4f);
}

TEST(Glass, Defaults) {
    const Bsdf bsdf = BsdfOf("glass", 1);
    EXPECT_EQ(bsdf.LobeCount(LobeSet::NonSpecular), 0);
    const auto& glass = LobeAt<FresnelSpecular>(bsdf, 0);
    ExpectGrey(glass.r, 1);
    ExpectGrey(glass.t, 1);
    EXPECT_EQ(glass.eta, 1.5f);
    EXPECT_EQ(bsdf.Eta(), 1.5f);
}

TEST(Glass, EtaComesBeforeIndex) {
    EXPECT_EQ(BsdfOf("glass", 1, {Float("index", 1.3f)}).Eta(), 1.3f);
    MaterialScene b;  // warns of the index, which has no effect
    b.AddMaterial("glass", {Float("index", 1.3f), Float("eta", 1.7f)});
    EXPECT_EQ(b.MakeBsdf(0).Eta(), 1.7f);
}

TEST(IndexOfRefraction, IsRefusedWhereItCannotBeOne) {
    for (const char* kind : {"glass", "uber", "disney", "hair"})
        for (const float eta : {-1.f, 0.f, 1e30f, std::nanf("")}) {
            MaterialScene b;
            b.AddMaterial(kind, {Float("eta", eta)});
            const std::string error = ErrorOf(&b);
            EXPECT_TRUE(error.starts_with("scene.pbrt:10: \"eta\" of material \"" +
                                          std::string(kind) + "\" has to lie between"))
                << error;
        }
}

// Texture or not, what is left of light is never more than there was.
TEST(IndexOfRefraction, IsOneWhereATextureHasNone) {
    MaterialScene b;
    b.AddChecks(false, 2, -1);
    b.AddMaterial("uber", {Textured("eta", 0, false)});
    EXPECT_EQ(b.MakeBsdf(0).Eta(), 1);
}

TEST(Glass, IsRoughIfEitherTangentIs) {
    const Bsdf bsdf = BsdfOf("glass", 2, {Float("vroughness", 0.1f)});
    ASSERT_EQ(bsdf.LobeCount(LobeSet::NonSpecular), 2);
    const auto& r = LobeAt<DielectricReflection>(bsdf, 0);
    EXPECT_EQ(r.interface.eta, 1.5f);
    EXPECT_NEAR(r.distribution.AlphaX(), RoughnessToAlpha(0), 1e-5f);
    EXPECT_NEAR(r.distribution.AlphaY(), RoughnessToAlpha(0.1f), 1e-5f);
    EXPECT_EQ(LobeAt<MicrofacetTransmission>(bsdf, 1).eta, 1.5f);
}

TEST(Glass, BlackPartsOfRoughGlassHaveNoLobe) {
    const Bsdf bsdf = BsdfOf("glass", 1, {Float("uroughness", 0.1f), Grey("Kr", 0)});
    LobeAt<MicrofacetTransmission>(bsdf, 0);
    // Smooth glass keeps its one lobe.
    BsdfOf("glass", 1, {Grey("Kr", 0)});
}

TEST(Mirror, Defaults) {
    ExpectGrey(LobeAt<SpecularReflection<PerfectMirror>>(BsdfOf("mirror", 1), 0).r, 0.9f);
}

TEST(Uber, Defaults) {
    const Bsdf bsdf = BsdfOf("uber", 2);
    ExpectGrey(LobeAt<LambertianReflection>(bsdf, 0).r, 0.25f);
    const auto& coat = LobeAt<DielectricReflection>(bsdf, 1);
    ExpectGrey(coat.r, 0.25f);
    EXPECT_EQ(coat.interface.eta, 1.5f);
    EXPECT_NEAR(coat.distribution.AlphaX(), RoughnessToAlpha(0.1f), 1e-5f);
    EXPECT_EQ(bsdf.Eta(), 1.5f);
}

TEST(Uber, HasAllItsLobesInOrder) {
    const Bsdf bsdf = BsdfOf("uber", 5,
                             {Grey("opacity", 0.5f), Grey("Kr", 0.4f), Grey("Kt", 0.2f),
                              Float("uroughness", 0.3f), Bool("remaproughness", false)});
    ExpectGrey(LobeAt<SpecularTransmission>(bsdf, 0).t, 0.5f);
    EXPECT_EQ(LobeAt<SpecularTransmission>(bsdf, 0).eta, 1);
    ExpectGrey(LobeAt<LambertianReflection>(bsdf, 1).r, 0.125f);
    ExpectGrey(LobeAt<DielectricReflection>(bsdf, 2).r, 0.125f);
    EXPECT_FLOAT_EQ(LobeAt<DielectricReflection>(bsdf, 2).distribution.AlphaY(), 0.3f);
    ExpectGrey(LobeAt<SpecularReflection<DielectricInterface>>(bsdf, 3).r, 0.2f);
    ExpectGrey(LobeAt<SpecularTransmission>(bsdf, 4).t, 0.1f);
    EXPECT_EQ(LobeAt<SpecularTransmission>(bsdf, 4).eta, 1.5f);
    EXPECT_EQ(bsdf.Eta(), 1);  // what is see-through does not bend
}

TEST(Substrate, Defaults) {
    const Bsdf bsdf = BsdfOf("substrate", 1);
    const auto& blend = LobeAt<FresnelBlend>(bsdf, 0);
    ExpectGrey(blend.rd, 0.5f);
    ExpectGrey(blend.rs, 0.5f);
    ExpectGrey(blend.scale, 1);
    EXPECT_NEAR(blend.distribution.AlphaX(), RoughnessToAlpha(0.1f), 1e-5f);
}

TEST(Translucent, Defaults) {
    const Bsdf bsdf = BsdfOf("translucent", 4);
    ExpectGrey(LobeAt<LambertianReflection>(bsdf, 0).r, 0.125f);
    ExpectGrey(LobeAt<LambertianTransmission>(bsdf, 1).t, 0.125f);
    ExpectGrey(LobeAt<DielectricReflection>(bsdf, 2).r, 0.125f);
    ExpectGrey(LobeAt<MicrofacetTransmission>(bsdf, 3).t, 0.125f);
    EXPECT_EQ(LobeAt<MicrofacetTransmission>(bsdf, 3).eta, 1.5f);
    EXPECT_EQ(bsdf.Eta(), 1.5f);
}

TEST(Disney, Defaults) {
    const Bsdf bsdf = BsdfOf("disney", 3);
    using Part = DisneyDiffuse::Part;
    ExpectGrey(LobeAt<DisneyDiffuse>(bsdf, 0).r, 0.5f);
    EXPECT_EQ(LobeAt<DisneyDiffuse>(bsdf, 0).part, Part::Base);
    EXPECT_EQ(LobeAt<DisneyDiffuse>(bsdf, 1).part, Part::RetroReflection);
    const auto& reflection = LobeAt<DisneyReflection>(bsdf, 2);
    EXPECT_FLOAT_EQ(reflection.distribution.AlphaX(), 0.25f);
    EXPECT_FLOAT_EQ(reflection.distribution.AlphaY(), 0.25f);
    ExpectGrey(reflection.interface.r0, 0.04f);
    EXPECT_EQ(bsdf.Eta(), 1);
}

TEST(Disney, AddsWhatItsWeightsAskFor) {
    const Bsdf bsdf =
        BsdfOf("disney", 8,
               {Bool("thin", true), Grey("color", 0.64f), Float("metallic", 0.5f),
                Float("anisotropic", 1), Float("roughness", 0.6f), Float("sheen", 0.5f),
                Float("clearcoat", 0.7f), Float("clearcoatgloss", 0), Float("spectrans", 0.2f),
                Float("flatness", 0.25f), Float("difftrans", 0.5f), Float("eta", 1.3f)});
    const float diffuse = 0.5f * 0.8f * 0.64f;
    ExpectGrey(LobeAt<DisneyDiffuse>(bsdf, 0).r, diffuse * 0.75f * 0.75f);
    ExpectGrey(LobeAt<DisneyDiffuse>(bsdf, 1).r, diffuse * 0.25f * 0.75f);
    ExpectGrey(LobeAt<DisneyDiffuse>(bsdf, 2).r, diffuse);
    ExpectGrey(LobeAt<DisneyDiffuse>(bsdf, 3).r, 0.5f * 0.8f * 0.5f);
    const float aspect = std::sqrt(0.1f);
    EXPECT_NEAR(LobeAt<DisneyReflection>(bsdf, 4).distribution.AlphaX(), 0.36f / aspect, 1e-5);
    EXPECT_NEAR(LobeAt<DisneyReflection>(bsdf, 4).distribution.AlphaY(), 0.36f * aspect, 1e-5);
    EXPECT_FLOAT_EQ(LobeAt<DisneyClearcoat>(bsdf, 5).alpha, 0.1f);
    ExpectGrey(LobeAt<MicrofacetTransmission>(bsdf, 6).t, 0.2f * 0.8f);
    EXPECT_NEAR(LobeAt<MicrofacetTransmission>(bsdf, 6).distribution.AlphaX(),
                Sqr((0.65f * 1.3f - 0.35f) * 0.6f) / aspect, 1e-5);
    ExpectGrey(LobeAt<LambertianTransmission>(bsdf, 7).t, 0.25f * 0.64f);
}

TEST(Disney, ScattersBelowTheSurfaceInsteadOfDiffusely) {
    MaterialScene b;
    b.AddMaterial("disney", {Grey("scatterdistance", 0.1f), Float("eta", 1.3f)});
    b.AddMaterial("disney", {Grey("scatterdistance", 0)});
    const MaterialTable table = b.Make();
    EXPECT_TRUE(table.Needs(0) & kScattersBelow);
    EXPECT_FALSE(table.Needs(1) & kScattersBelow);
    SurfaceInteraction hit = MaterialScene::Hit(0);
    EXPECT_EQ(LobeAt<SpecularTransmission>(table.MakeBsdf(b.textures, &hit), 0).eta, 1.3f);
    const auto profile = table.Profile(b.textures, hit);
    ASSERT_TRUE(profile);
    EXPECT_EQ(profile->eta, 1.3f);
    const BurleyProfile expected(Rgb(0.5f, 0.5f, 0.5f), Rgb(0.1f, 0.1f, 0.1f));
    EXPECT_EQ((*profile)(0.2f).x(), expected(0.2f).x());
}

TEST(Hair, ReadsWhatItAbsorbs) {
    MaterialScene b;
    b.AddMaterial("hair");
    b.AddMaterial("hair", {Grey("color", 0.5f)});
    b.AddMaterial("hair", {Grey("sigma_a", 3)});
    const auto lobe = [&](int i) { return LobeAt<HairLobe>(b.MakeBsdf(i), 0); };
    EXPECT_NEAR(lobe(0).sigmaA.r, 1.3f * 0.419f, 1e-5);
    EXPECT_NEAR(lobe(1).sigmaA.g, HairAbsorptionOfColor(Rgb(0.5f, 0.5f, 0.5f), 0.3f).y(), 1e-5);
    ExpectGrey(lobe(2).sigmaA, 3);
    // uv.y() is 0.25.
    EXPECT_FLOAT_EQ(lobe(0).h, -0.5f);
    EXPECT_FLOAT_EQ(b.MakeBsdf(0).Eta(), 1.55f);
    EXPECT_EQ(b.Make().Needs(0), kNeedsUv | kNeedsTangents);
}

TEST(Interface, IsNothing) {
    MaterialScene b;
    b.AddMaterial("none");
    b.AddMaterial("");
    for (const int i : {0, 1}) {
        EXPECT_EQ(b.Make().Needs(i), kIsInterface);
        EXPECT_EQ(b.MakeBsdf(i).LobeCount(LobeSet::All), 0);
    }
}

}  // namespace
}  // namespace lull::test
