// Puts materials of all kinds into a white furnace: at most what arrives leaves towards the viewer,
// whatever its side and angle.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <optional>

#include "renderer/base/math.h"
#include "tests/renderer/scene/materials/material_scene.h"

namespace lull::test {
namespace {

struct White {
    const char* kind;
    std::vector<Parameter> parameters;
};

// glTF's material, white, of these factors.
White Gltf(const std::map<std::string, float>& factors, bool isSolid = false,
           const std::vector<Parameter>& more = {}) {
    White white{"metallicroughness", {Grey("basecolorfactor", 1), Grey("sheencolorfactor", 0)}};
    for (const auto& [name, value] : factors) {
        const bool isColor = name.find("color") != std::string::npos;
        white.parameters.push_back(isColor ? Grey(name, value) : Float(name, value));
    }
    if (isSolid) white.parameters.push_back(Bool("solid", true));
    white.parameters.insert(white.parameters.end(), more.begin(), more.end());
    return white;
}

std::vector<White> Materials() {
    std::vector<White> all = {
        {"matte", {Grey("Kd", 1)}},
        {"matte", {Grey("Kd", 1), Float("sigma", 20)}},
        {"mirror", {Grey("Kr", 1)}},
        {"subsurface", {}},
        {"kdsubsurface", {}},
        {"thindielectric", {Float("eta", 1.5f)}},
        {"none", {}},
        {"translucent", {Grey("Kd", 0), Grey("Ks", 1)}},
        {"uber", {Grey("Kd", 0.2f), Grey("Ks", 0.2f), Grey("Kr", 0.2f), Grey("Kt", 0.2f)}},
        {"uber", {Grey("Kd", 0.5f), Grey("Ks", 0.5f), Grey("opacity", 0.3f)}},
        {"hair", {Grey("sigma_a", 0)}},
        {"metal",
         {Grey("eta", 0), Grey("k", 1), Float("uroughness", 0.1f), Float("vroughness", 1)}},
    };
    for (const float r : {0.f, 0.01f, 0.3f, 1.f}) {
        all.push_back({"metal", {Grey("eta", 0), Grey("k", 1), Float("roughness", r)}});
        for (const float eta : {1.f, 1.5f})
            all.push_back(
                {"glass", {Float("eta", eta), Float("uroughness", r), Float("vroughness", r)}});
        all.push_back({"plastic", {Grey("Kd", 0.5f), Grey("Ks", 0.5f), Float("roughness", r)}});
        all.push_back(
            {"substrate",
             {Grey("Kd", 0.5f), Grey("Ks", 0.5f), Float("uroughness", r), Float("vroughness", r)}});
        all.push_back({"coateddiffuse",
                       {Grey("reflectance", 1), Float("uroughness", r), Float("vroughness", r)}});
        all.push_back({"coatedconductor",
                       {Grey("reflectance", 1), Float("interface.uroughness", r),
                        Float("interface.vroughness", r)}});
        all.push_back({"coatedconductor",
                       {Grey("reflectance", 1), Float("conductor.uroughness", r),
                        Float("conductor.vroughness", r)}});
    }
    using Factors = std::map<std::string, float>;
    const std::vector<Factors> layers = {
        {},
        {{"clearcoatfactor", 1}},
        {{"clearcoatfactor", 1}, {"clearcoatroughnessfactor", 0.03f}},
        {{"clearcoatfactor", 0.5f}, {"clearcoatroughnessfactor", 0.5f}},
        {{"sheencolorfactor", 1}, {"sheenroughnessfactor", 0.3f}},
        {{"sheencolorfactor", 1}, {"sheenroughnessfactor", 1}, {"clearcoatfactor", 1}}};
    const std::vector<std::pair<Factors, bool>> bases = {
        {{{"metallicfactor", 1}}, false},
        {{{"metallicfactor", 0}}, false},
        {{{"metallicfactor", 0}, {"anisotropyfactor", 0.7f}}, false},
        {{{"metallicfactor", 0.5f}, {"transmissionfactor", 0.5f}}, false},
        {{{"metallicfactor", 0}, {"ior", 0}}, false},
        {{{"metallicfactor", 0}, {"transmissionfactor", 1}}, false},
        {{{"metallicfactor", 0}, {"transmissionfactor", 1}}, true},
        {{{"metallicfactor", 0}, {"transmissionfactor", 0.5f}, {"ior", 1}}, true},
        {{{"metallicfactor", 0}, {"diffusetransmissionfactor", 0.5f}}, false}};
    for (const auto& [base, isSolid] : bases)
        for (const Factors& layer : layers)
            for (const float roughness : {0.f, 0.3f, 1.f}) {
                Factors factors = base;
                factors.insert(layer.begin(), layer.end());
                factors["roughnessfactor"] = roughness;
                all.push_back(Gltf(factors, isSolid));
            }
    return all;
}

std::string NameOf(const White& white) {
    std::string name = white.kind;
    for (const Parameter& p : white.parameters)
        if (const auto* values = std::get_if<std::vector<float>>(&p.values))
            name += fmt::format(" {} {}", p.name, values->at(0));
    return name;
}

// Returns the share of even light around the surface that it scatters to wo, by a lattice of
// samples. Refracted radiance is taken back to the index that it came from.
double Reflectance(const MaterialTable& table, const TextureTable& textures, int material,
                   const Vec3f& wo, int samples) {
    SurfaceInteraction hit = MaterialScene::Hit(material);
    hit.wo = wo;
    Bsdf bsdf = table.MakeBsdf(textures, &hit);
    bsdf.ChooseByShare(wo);
    double sum = 0;
    for (int i = 0; i < samples && bsdf.LobeCount(LobeSet::All) > 0; ++i) {
        const double along = (i + 0.5) / samples, across = (i + 0.5) / std::numbers::phi;
        const auto s =
            bsdf.Sample(wo, Vec2f(float(along), float(across - std::floor(across))), LobeSet::All);
        if (!s) continue;
        const float index2 = Sqr(bsdf.Eta());
        const float scale = !s->isTransmission ? 1 : wo.z() > 0 ? index2 : 1 / index2;
        sum += double(s->f.maxCoeff() * std::abs(s->wi.z()) / s->pdf * scale);
    }
    return sum / samples;
}

TEST(Furnace, GetsNoMoreFromAMaterialThanItGives) {
    MaterialScene scene;
    const std::vector<White> materials = Materials();
    for (const White& white : materials) scene.AddMaterial(white.kind, white.parameters);
    const MaterialTable table = scene.Make();
    for (size_t i = 0; i < materials.size(); ++i)
        for (const float cosine : {1.f, 0.3f, 0.01f, -0.01f, -0.3f, -1.f}) {
            const Vec3f wo(0.6f * std::sqrt(1 - Sqr(cosine)), 0.8f * std::sqrt(1 - Sqr(cosine)),
                           cosine);
            // Tables of albedo are right to 0.01 near the horizon.
            const double most = 1 + (std::abs(cosine) < 0.1f ? 0.01 : 1.5e-3);
            double found = most;
            for (int samples = 1 << 12; samples <= 1 << 20 && !(found < most); samples *= 16)
                found = Reflectance(table, scene.textures, int(i), wo, samples);
            EXPECT_LT(found, most) << NameOf(materials[i]) << " at cosine " << cosine;
        }
}

// Where light is not refracted, formulas of rough interfaces have 0 / 0; a coat of that index is
// none.
TEST(Furnace, ACoatOfTheIndexAroundItIsNone) {
    std::optional<double> smooth;
    for (const float roughness : {0.f, 0.01f, 0.3f})
        for (const float eta : {1.f, std::nextafter(1.f, 2.f)}) {
            MaterialScene scene;
            scene.AddMaterial(
                "coatedconductor",
                {Grey("reflectance", 1), Float("interface.eta", eta),
                 Float("interface.uroughness", roughness), Float("interface.vroughness", roughness),
                 Float("conductor.uroughness", 0.2f), Float("conductor.vroughness", 0.2f),
                 Float("thickness", 0)});
            const double found =
                Reflectance(scene.Make(), scene.textures, 0, Vec3f(0.6f, 0, 0.8f), 1 << 14);
            if (!smooth) smooth = found;
            EXPECT_GT(found, 0.5);
            EXPECT_NEAR(found, *smooth, 0.01) << roughness << " " << eta;
        }
}

}  // namespace
}  // namespace lull::test
