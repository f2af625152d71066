// Checks parameters, defaults and lobes of each kind of material.
#include <gtest/gtest.h>

#include "renderer/input/spectrum.h"
#include "tests/renderer/scene/material_scene.h"

namespace lull::test {
namespace {

TEST(Matte, Defaults) {
    MaterialScene b;
    b.AddMaterial("matte");
    const Bsdf bsdf = b.MakeBsdf(0);
    ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 1);
    ExpectGrey(LobeAt<LambertianReflection>(bsdf, 0).r, 0.5f);
    EXPECT_EQ(bsdf.Eta(), 1);
    EXPECT_TRUE(b.messages.empty());
}

TEST(Matte, SigmaMakesItRough) {
    MaterialScene b;
    MaterialEntity& m = b.AddMaterial("matte");
    AddFloat(&m, "sigma", 200);
    const OrenNayar clamped(Rgb::Constant(0.5f), 90);
    EXPECT_FLOAT_EQ(LobeAt<OrenNayar>(b.MakeBsdf(0), 0).a, clamped.a);
    EXPECT_FLOAT_EQ(LobeAt<OrenNayar>(b.MakeBsdf(0), 0).b, clamped.b);
}

TEST(Matte, BlackHasNoLobe) {
    MaterialScene b;
    AddRgb(&b.AddMaterial("matte"), "Kd", Rgb(0, -1, 0));
    EXPECT_EQ(b.MakeBsdf(0).LobeCount(LobeSet::All), 0);
}

TEST(Plastic, Defaults) {
    MaterialScene b;
    b.AddMaterial("plastic");
    const Bsdf bsdf = b.MakeBsdf(0);
    ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 2);
    ExpectGrey(LobeAt<LambertianReflection>(bsdf, 0).r, 0.25f);
    const auto& coat = LobeAt<DielectricReflection>(bsdf, 1);
    ExpectGrey(coat.r, 0.25f);
    EXPECT_FLOAT_EQ(coat.interface.eta, 1 / 1.5f);  // the dense side outside, as pbrt-v3
    EXPECT_NEAR(coat.distribution.AlphaX(), RoughnessToAlpha(0.1f), 1e-5f);
    EXPECT_NEAR(coat.distribution.AlphaY(), RoughnessToAlpha(0.1f), 1e-5f);
    EXPECT_EQ(bsdf.Eta(), 1);
}

TEST(Plastic, RemapsRoughnessUnlessTold) {
    MaterialScene b;
    MaterialEntity& m = b.AddMaterial("plastic");
    AddFloat(&m, "roughness", 0.3f);
    AddBool(&m, "remaproughness", false);
    EXPECT_FLOAT_EQ(LobeAt<DielectricReflection>(b.MakeBsdf(0), 1).distribution.AlphaX(), 0.3f);
}

TEST(Metal, Defaults) {
    MaterialScene b;
    b.AddMaterial("metal");
    const Bsdf bsdf = b.MakeBsdf(0);
    ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 1);
    const auto& metal = LobeAt<ConductorReflection>(bsdf, 0);
    ExpectGrey(metal.r, 1);
    EXPECT_NEAR(metal.distribution.AlphaX(), RoughnessToAlpha(0.01f), 1e-5f);
    const ConductorInterface copper(CopperEta(), CopperK());
    EXPECT_TRUE((metal.interface(0.7f) == copper(0.7f)).all());
    // Copper is red.
    EXPECT_GT(metal.interface(1).x(), metal.interface(1).z() + 0.2f);
}

TEST(Metal, RoughnessOfEachTangent) {
    MaterialScene b;
    MaterialEntity& m = b.AddMaterial("metal");
    AddFloat(&m, "roughness", 0.2f);
    AddFloat(&m, "vroughness", 0.4f);
    AddBool(&m, "remaproughness", false);
    const auto& d = LobeAt<ConductorReflection>(b.MakeBsdf(0), 0).distribution;
    EXPECT_FLOAT_EQ(d.AlphaX(), 0.2f);
    EXPECT_FLOAT_EQ(d.AlphaY(), 0.4f);
}

TEST(Glass, Defaults) {
    MaterialScene b;
    b.AddMaterial("glass");
    const Bsdf bsdf = b.MakeBsdf(0);
    ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 1);
    EXPECT_EQ(bsdf.LobeCount(LobeSet::NonSpecular), 0);
    const auto& glass = LobeAt<FresnelSpecular>(bsdf, 0);
    ExpectGrey(glass.r, 1);
    ExpectGrey(glass.t, 1);
    EXPECT_EQ(glass.eta, 1.5f);
    EXPECT_EQ(bsdf.Eta(), 1.5f);
}

TEST(Glass, EtaComesBeforeIndex) {
    MaterialScene b;
    AddFloat(&b.AddMaterial("glass"), "index", 1.3f);
    MaterialEntity& m = b.AddMaterial("glass");
    AddFloat(&m, "index", 1.3f);
    AddFloat(&m, "eta", 1.7f);
    EXPECT_EQ(b.MakeBsdf(0).Eta(), 1.3f);
    EXPECT_EQ(b.MakeBsdf(1).Eta(), 1.7f);
}

TEST(Glass, IsRoughIfEitherTangentIs) {
    MaterialScene b;
    AddFloat(&b.AddMaterial("glass"), "vroughness", 0.1f);
    const Bsdf bsdf = b.MakeBsdf(0);
    ASSERT_EQ(bsdf.LobeCount(LobeSet::NonSpecular), 2);
    const auto& r = LobeAt<DielectricReflection>(bsdf, 0);
    EXPECT_EQ(r.interface.eta, 1.5f);
    EXPECT_NEAR(r.distribution.AlphaX(), RoughnessToAlpha(0), 1e-5f);
    EXPECT_NEAR(r.distribution.AlphaY(), RoughnessToAlpha(0.1f), 1e-5f);
    EXPECT_EQ(LobeAt<MicrofacetTransmission>(bsdf, 1).eta, 1.5f);
}

TEST(Glass, BlackPartsOfRoughGlassHaveNoLobe) {
    MaterialScene b;
    MaterialEntity& m = b.AddMaterial("glass");
    AddFloat(&m, "uroughness", 0.1f);
    AddGrey(&m, "Kr", 0);
    const Bsdf bsdf = b.MakeBsdf(0);
    ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 1);
    LobeAt<MicrofacetTransmission>(bsdf, 0);
    // Smooth glass keeps its one lobe.
    AddGrey(&b.AddMaterial("glass"), "Kr", 0);
    EXPECT_EQ(b.MakeBsdf(1).LobeCount(LobeSet::All), 1);
}

TEST(Mirror, Defaults) {
    MaterialScene b;
    b.AddMaterial("mirror");
    ExpectGrey(LobeAt<SpecularReflection<PerfectMirror>>(b.MakeBsdf(0), 0).r, 0.9f);
}

TEST(Uber, Defaults) {
    MaterialScene b;
    b.AddMaterial("uber");
    const Bsdf bsdf = b.MakeBsdf(0);
    ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 2);
    ExpectGrey(LobeAt<LambertianReflection>(bsdf, 0).r, 0.25f);
    const auto& coat = LobeAt<DielectricReflection>(bsdf, 1);
    ExpectGrey(coat.r, 0.25f);
    EXPECT_EQ(coat.interface.eta, 1.5f);
    EXPECT_NEAR(coat.distribution.AlphaX(), RoughnessToAlpha(0.1f), 1e-5f);
    EXPECT_EQ(bsdf.Eta(), 1.5f);
}

TEST(Uber, HasAllItsLobesInOrder) {
    MaterialScene b;
    MaterialEntity& m = b.AddMaterial("uber");
    AddGrey(&m, "opacity", 0.5f);
    AddGrey(&m, "Kr", 0.4f);
    AddGrey(&m, "Kt", 0.2f);
    AddFloat(&m, "uroughness", 0.3f);
    AddBool(&m, "remaproughness", false);
    const Bsdf bsdf = b.MakeBsdf(0);
    ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 5);
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
    MaterialScene b;
    b.AddMaterial("substrate");
    const Bsdf bsdf = b.MakeBsdf(0);
    ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 1);
    const auto& blend = LobeAt<FresnelBlend>(bsdf, 0);
    ExpectGrey(blend.rd, 0.5f);
    ExpectGrey(blend.rs, 0.5f);
    ExpectGrey(blend.scale, 1);
    EXPECT_NEAR(blend.distribution.AlphaX(), RoughnessToAlpha(0.1f), 1e-5f);
}

TEST(Translucent, Defaults) {
    MaterialScene b;
    b.AddMaterial("translucent");
    const Bsdf bsdf = b.MakeBsdf(0);
    ASSERT_EQ(bsdf.LobeCount(LobeSet::All), 4);
    ExpectGrey(LobeAt<LambertianReflection>(bsdf, 0).r, 0.125f);
    ExpectGrey(LobeAt<LambertianTransmission>(bsdf, 1).t, 0.125f);
    ExpectGrey(LobeAt<DielectricReflection>(bsdf, 2).r, 0.125f);
    ExpectGrey(LobeAt<MicrofacetTransmission>(bsdf, 3).t, 0.125f);
    EXPECT_EQ(LobeAt<MicrofacetTransmission>(bsdf, 3).eta, 1.5f);
    EXPECT_EQ(bsdf.Eta(), 1.5f);
}

}  // namespace
}  // namespace lull::test
