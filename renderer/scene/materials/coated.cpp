#include "renderer/input/spectrum.h"
#include "renderer/scene/materials/basic.h"

namespace lull {
namespace {

// Below, pbrt-v4 takes a rough surface for a smooth one.
constexpr float kLeastAlpha = 1e-3f;

float ReadIndex(const MaterialReader& in, const char* name) {
    return in.entity.parameters.GetFloat(name, 1.5f);
}

// Returns alpha of a table that has one for both axes; nothing where it varies.
std::optional<float> ConstantAlpha(const Roughness& roughness, const MaterialReader& in) {
    if (!in.TraitsOf(0, roughness).isConstant) return {};
    const TextureContext nowhere{Vec3f::Zero(), Vec2f::Zero()};
    bool isSmooth;
    const TrowbridgeReitz d = roughness.Evaluate({in.textures, nowhere, in.made}, &isSmooth);
    return isSmooth ? 0 : std::sqrt(d.AlphaX() * d.AlphaY());
}

std::shared_ptr<const CoatTable> MakeTable(const Roughness& roughness, float eta,
                                           const MaterialReader& in) {
    if (!IsIndexOfRefraction(eta)) return nullptr;
    const float thickness = GetNonnegative(in.entity, "thickness", 0.01f);
    if (const auto alpha = ConstantAlpha(roughness, in))
        return std::make_shared<const CoatTable>(*alpha, eta, thickness);
    return std::make_shared<const CoatTable>(eta, thickness);
}

Roughness ReadRoughness(const MaterialReader& in, const std::string& prefix) {
    return {in, in.Float(prefix + "uroughness", 0), in.Float(prefix + "vroughness", 0)};
}

}  // namespace

CoatedDiffuse::CoatedDiffuse(const MaterialReader& in)
    : reflectance(in.ShareOfColors("reflectance", 0.5f)),
      roughness(ReadRoughness(in, "")),
      eta(ReadIndex(in, "eta")),
      table(MakeTable(roughness, eta, in)) {}

void CoatedDiffuse::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    bool isSmooth;
    const TrowbridgeReitz distribution = roughness.Evaluate(in, &isSmooth);
    float blend;
    const float alpha = isSmooth ? 0 : std::sqrt(distribution.AlphaX() * distribution.AlphaY());
    const CoatRow* row = table->RowOf(alpha, &blend);
    if (isSmooth) bsdf->Add(SpecularReflection<CoatInterface>{Rgb(1, 1, 1), CoatInterface{eta}});
    bsdf->Add(CoatedDiffuseLobe{Rgb(in.Color(reflectance).min(1.f)), distribution, row, blend});
}

CoatedConductor::CoatedConductor(const MaterialReader& in)
    : eta(in.Spectrum("eta", 1)),
      k(in.Spectrum("k", 0)),
      reflectance(SpectrumOrNone(in, "reflectance")),
      coat(ReadRoughness(in, "interface.")),
      base(ReadRoughness(in, "conductor.")),
      index(ReadIndex(in, "interface.eta")),
      thickness(GetNonnegative(in.entity, "thickness", 0.01f)) {}

void CoatedConductor::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    Rgb n = in.Color(eta), absorption = in.Color(k);
    if (reflectance) {
        n = Rgb::Ones();
        absorption = AbsorptionOf(in.Color(*reflectance));
    }
    n /= index;
    absorption /= index;
    bool isCoatSmooth, isBaseSmooth;
    const TrowbridgeReitz top = coat.Evaluate(in, &isCoatSmooth);
    const TrowbridgeReitz below = base.Evaluate(in, &isBaseSmooth);
    if (isCoatSmooth && isBaseSmooth) {
        bsdf->Add(SpecularReflection<CoatedConductorInterface>{
            Rgb(1, 1, 1), CoatedConductorInterface{index, thickness, n, absorption}});
        return;
    }
    if (isCoatSmooth)
        bsdf->Add(SpecularReflection<CoatInterface>{Rgb(1, 1, 1), CoatInterface{index}});
    CoatedConductorLobe lobe{.n = n,
                             .k = absorption,
                             .eta = index,
                             .thickness = thickness,
                             .coatAlpha = {0, 0},
                             .baseAlpha = {0, 0}};
    const auto store = [](bool isSmooth, const TrowbridgeReitz& d, uint16_t* to) {
        if (isSmooth) return;
        to[0] = CoatedConductorLobe::StoreAlpha(std::max(d.AlphaX(), kLeastAlpha));
        to[1] = CoatedConductorLobe::StoreAlpha(std::max(d.AlphaY(), kLeastAlpha));
    };
    store(isCoatSmooth, top, lobe.coatAlpha);
    store(isBaseSmooth, below, lobe.baseAlpha);
    bsdf->Add(lobe);
}

}  // namespace lull
