#include "renderer/scene/materials/basic.h"

#include "renderer/base/math.h"
#include "renderer/input/spectrum.h"

namespace lull {

void Matte::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    const Rgb r = in.Color(kd);
    if (IsBlack(r)) return;
    const float degrees = std::clamp(in(sigma), 0.f, 90.f);
    if (degrees == 0)
        bsdf->Add(LambertianReflection{r});
    else
        bsdf->Add(OrenNayar(r, degrees));
}

void Mirror::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    const Rgb r = in.Color(kr);
    if (!IsBlack(r)) bsdf->Add(SpecularReflection<PerfectMirror>{r, {}});
}

Glass::Glass(const MaterialReader& in)
    : kr(in.ShareOfColors("Kr", 1)),
      kt(in.ShareOfColors("Kt", 1)),
      eta(in.IndexOfRefraction()),
      roughness(in, in.Float("uroughness", 0), in.Float("vroughness", 0)) {}

void Glass::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    AddDielectric(in.Color(kr), in.Color(kt), in.Index(eta), roughness, in, bsdf);
}

void AddDielectric(const Rgb& r, const Rgb& t, float eta, const Roughness& roughness,
                   const MaterialInputs& in, Bsdf* bsdf) {
    bsdf->SetEta(eta);
    if (IsBlack(r) && IsBlack(t)) return;
    bool isSmooth;
    const TrowbridgeReitz distribution = roughness.Evaluate(in, &isSmooth);
    AddDielectricLobes(r, t, eta, isSmooth, distribution, bsdf);
}

void AddDielectricLobes(const Rgb& r, const Rgb& t, float eta, bool isSmooth,
                        const TrowbridgeReitz& distribution, Bsdf* bsdf) {
    if (isSmooth) {
        bsdf->Add(FresnelSpecular{r, t, eta});
        return;
    }
    if (!IsBlack(r))
        bsdf->Add(MicrofacetReflection<DielectricInterface>{
            r, distribution, DielectricInterface{ResolvableIndex(eta)}});
    if (!IsBlack(t)) bsdf->Add(MicrofacetTransmission{t, distribution, ResolvableIndex(eta)});
}

namespace {

Roughness MetalRoughness(const MaterialReader& in) {
    const FloatTexture both = in.Float("roughness", 0.01f);
    return {in, in.FloatOrNone("uroughness").value_or(both),
            in.FloatOrNone("vroughness").value_or(both)};
}

Roughness UberRoughness(const MaterialReader& in) {
    const FloatTexture both = in.Float("roughness", 0.1f);
    const FloatTexture u = in.FloatOrNone("uroughness").value_or(both);
    return {in, u, in.FloatOrNone("vroughness").value_or(u)};
}

}  // namespace

Metal::Metal(const MaterialReader& in)
    : eta(in.textures.GetSpectrum(in.entity, "eta", CopperEta())),
      k(in.textures.GetSpectrum(in.entity, "k", CopperK())),
      reflectance(SpectrumOrNone(in, "reflectance")),
      roughness(MetalRoughness(in)),
      mirrors(in.entity.parameters.GetBool("mirrors", false)) {}

Rgb AbsorptionOf(const Rgb& reflectance) {
    const Rgb r = reflectance.min(0.9999f);
    return 2 * (r / (1 - r)).sqrt();
}

void Metal::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    const ConductorInterface interface =
        reflectance ? ConductorInterface{Rgb::Ones(), AbsorptionOf(in.Color(*reflectance))}
                    : ConductorInterface{in.Raw(eta), in.Raw(k)};
    bool isSmooth;
    const TrowbridgeReitz distribution = roughness.Evaluate(in, &isSmooth);
    if (mirrors && isSmooth)
        bsdf->Add(SpecularReflection<ConductorInterface>{Rgb(1, 1, 1), interface});
    else
        bsdf->Add(MicrofacetReflection<ConductorInterface>{Rgb(1, 1, 1), distribution, interface});
}

Plastic::Plastic(const MaterialReader& in)
    : kd(in.ShareOfColors("Kd", 0.25f)),
      ks(in.ShareOfColors("Ks", 0.25f)),
      roughness(in, in.Float("roughness", 0.1f), in.Float("roughness", 0.1f)) {}

void Plastic::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    const Rgb diffuse = in.Color(kd), glossy = in.Color(ks);
    if (!IsBlack(diffuse)) bsdf->Add(LambertianReflection{diffuse});
    if (IsBlack(glossy)) return;
    // pbrt-v3 has the dense side of the interface outside, so that the coat reflects totally at
    // grazing angles; its images of plastic look the way they do because of it.
    bsdf->Add(MicrofacetReflection<DielectricInterface>{glossy, roughness.Evaluate(in),
                                                        DielectricInterface{1 / 1.5f}});
}

Substrate::Substrate(const MaterialReader& in)
    : kd(in.ShareOfColors("Kd", 0.5f)),
      ks(in.ShareOfColors("Ks", 0.5f)),
      roughness(in, in.Float("uroughness", 0.1f), in.Float("vroughness", 0.1f)) {}

void Substrate::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    const Rgb diffuse = in.Color(kd), glossy = in.Color(ks);
    if (IsBlack(diffuse) && IsBlack(glossy)) return;
    bsdf->Add(FresnelBlend{diffuse, glossy, roughness.Evaluate(in)});
}

Translucent::Translucent(const MaterialReader& in)
    : kd(in.ShareOfColors("Kd", 0.25f)),
      ks(in.ShareOfColors("Ks", 0.25f)),
      reflect(in.ShareOfColors("reflect", 0.5f)),
      transmit(in.ShareOfColors("transmit", 0.5f)),
      roughness(in, in.Float("roughness", 0.1f), in.Float("roughness", 0.1f)) {}

void Translucent::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    constexpr float kIndex = 1.5f;
    bsdf->SetEta(kIndex);
    const Rgb r = in.Color(reflect), t = in.Color(transmit);
    if (IsBlack(r) && IsBlack(t)) return;
    // A black product still counts as a lobe: that is how pbrt-v3 chooses among them.
    const Rgb diffuse = in.Color(kd);
    if (!IsBlack(diffuse)) {
        if (!IsBlack(r)) bsdf->Add(LambertianReflection{Rgb(r * diffuse)});
        if (!IsBlack(t)) bsdf->Add(LambertianTransmission{Rgb(t * diffuse)});
    }
    const Rgb glossy = in.Color(ks);
    if (!IsBlack(glossy)) {
        const TrowbridgeReitz distribution = roughness.Evaluate(in);
        if (!IsBlack(r))
            bsdf->Add(MicrofacetReflection<DielectricInterface>{Rgb(r * glossy), distribution,
                                                                DielectricInterface{kIndex}});
        if (!IsBlack(t)) bsdf->Add(MicrofacetTransmission{Rgb(t * glossy), distribution, kIndex});
    }
}

Uber::Uber(const MaterialReader& in)
    : kd(in.ShareOfColors("Kd", 0.25f)),
      ks(in.ShareOfColors("Ks", 0.25f)),
      kr(in.ShareOfColors("Kr", 0)),
      kt(in.ShareOfColors("Kt", 0)),
      opacity(in.ShareOfColors("opacity", 1)),
      eta(in.IndexOfRefraction()),
      roughness(UberRoughness(in)) {}

MaterialTraits Uber::Traits(const MaterialReader& in) const {
    const bool isOpaque = opacity.IsConstant() && (opacity.constant >= 1).all();
    int count = !isOpaque;
    for (const SpectrumTexture* t : {&kd, &ks, &kr, &kt})
        count += !IsAlwaysBlack(*t) && !IsAlwaysBlack(opacity);
    return in.TraitsOf(count, kd, ks, kr, kt, opacity, eta, roughness);
}

void Uber::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    const float index = in.Index(eta);
    const Rgb op = in.Color(opacity), through = (1 - op).max(0.f);
    if (IsBlack(through))
        bsdf->SetEta(index);
    else
        bsdf->Add(SpecularTransmission{through, 1});

    const Rgb diffuse = op * in.Color(kd);
    if (!IsBlack(diffuse)) bsdf->Add(LambertianReflection{diffuse});
    const Rgb glossy = op * in.Color(ks);
    if (!IsBlack(glossy))
        bsdf->Add(MicrofacetReflection<DielectricInterface>{glossy, roughness.Evaluate(in),
                                                            DielectricInterface{index}});
    const Rgb mirror = op * in.Color(kr);
    if (!IsBlack(mirror))
        bsdf->Add(SpecularReflection<DielectricInterface>{mirror, DielectricInterface{index}});
    const Rgb glass = op * in.Color(kt);
    if (!IsBlack(glass)) bsdf->Add(SpecularTransmission{glass, index});
}

Disney::Disney(const MaterialReader& in)
    : color(in.ShareOfColors("color", 0.5f)),
      scatterDistance(in.Spectrum("scatterdistance", 0)),
      metallic(in.Share("metallic", 0)),
      eta(in.Float("eta", 1.5f)),
      rough(in.Float("roughness", 0.5f)),
      specularTint(in.Share("speculartint", 0)),
      anisotropic(in.Share("anisotropic", 0)),
      sheen(in.Share("sheen", 0)),
      sheenTint(in.Share("sheentint", 0.5f)),
      clearcoat(in.Share("clearcoat", 0)),
      clearcoatGloss(in.Share("clearcoatgloss", 1)),
      specTrans(in.Share("spectrans", 0)),
      thin(in.entity.parameters.GetBool("thin", false)),
      flatness(in.Share("flatness", 0)),
      diffTrans(in.Float("difftrans", 1)) {}

MaterialTraits Disney::Traits(const MaterialReader& in) const {
    const auto canBe = [](const FloatTexture& t) { return !(t.IsConstant() && t.constant <= 0); };
    // Base, retro-reflection, specular reflection; of thin ones a flat base and transmission.
    const int most = 3 + 2 * thin + canBe(sheen) + canBe(clearcoat) + canBe(specTrans);
    MaterialTraits traits =
        in.TraitsOf(most, color, scatterDistance, metallic, eta, rough, specularTint, anisotropic,
                    sheen, sheenTint, clearcoat, clearcoatGloss, specTrans, flatness, diffTrans);
    if (!(anisotropic.IsConstant() && anisotropic.constant == 0))
        traits.needs = traits.needs | kNeedsTangents;
    if (!thin && !IsAlwaysBlack(scatterDistance)) traits.Need(kScattersBelow | kNeedsTangents);
    return traits;
}

void Disney::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    using Part = DisneyDiffuse::Part;
    const Rgb c = in.Color(color);
    const float metal = in(metallic), index = in.Index(eta), through = in(specTrans);
    const float roughness = in(rough), transmitted = in(diffTrans) / 2;
    const float diffuse = (1 - metal) * (1 - through);
    const float luminance = Luminance(c);
    const Rgb tint = luminance > 0 ? Rgb(c / luminance) : Rgb(Rgb::Ones());
    const auto tinted = [&](float amount) { return Rgb((1 - amount) + amount * tint); };
    // As in pbrt-v3 a part whose weight is black stays among those to choose from.
    const auto add = [&](const Rgb& r, Part part) {
        bsdf->Add(DisneyDiffuse{Rgb(r.max(0.f)), roughness, part});
    };
    if (diffuse > 0) {
        if (thin) {
            const float flat = in(flatness);
            add(diffuse * (1 - flat) * (1 - transmitted) * c, Part::Base);
            add(diffuse * flat * (1 - transmitted) * c, Part::FakeSubsurface);
        } else {
            if (Profile(in))
                bsdf->Add(SpecularTransmission{Rgb(1, 1, 1), index});
            else
                add(diffuse * c, Part::Base);
        }
        add(diffuse * c, Part::RetroReflection);
        if (const float weight = in(sheen); weight > 0)
            add(diffuse * weight * tinted(in(sheenTint)), Part::Sheen);
    }

    const float aspect = std::sqrt(std::max(0.01f, 1 - in(anisotropic)*0.9f));
    const auto distribution = [&](float r) {
        return TrowbridgeReitz(Sqr(r) / aspect, Sqr(r) * aspect);
    };
    const Rgb dielectricR0 = Sqr((index - 1) / (index + 1)) * tinted(in(specularTint));
    const Rgb r0 = (1 - metal) * dielectricR0 + metal * c;
    bsdf->Add(
        DisneyReflection{Rgb(1, 1, 1), distribution(roughness), DisneyInterface{r0, metal, index}});
    if (const float weight = in(clearcoat); weight > 0) {
        // A coat of alpha 1 would be a quotient of zeros.
        const float alpha = std::clamp(Lerp(in(clearcoatGloss), 0.1f, 0.001f), 1e-4f, 0.99f);
        bsdf->Add(DisneyClearcoat{Rgb(weight, weight, weight), alpha});
    }
    if (through > 0) {
        // Its root, since light goes through two surfaces of a body.
        const Rgb t = through * c.sqrt();
        if (thin)
            bsdf->Add(MicrofacetTransmission{t, distribution((0.65f * index - 0.35f) * roughness),
                                             ResolvableIndex(index)});
        else
            bsdf->Add(DisneyTransmission{t, distribution(roughness), ResolvableIndex(index)});
    }
    if (thin) bsdf->Add(LambertianTransmission{Rgb((transmitted * c).max(0.f))});
}

std::optional<SubsurfaceProfile> Disney::Profile(const MaterialInputs& in) const {
    if (thin || IsAlwaysBlack(scatterDistance)) return {};
    const Rgb distance = in.Color(scatterDistance);
    const float diffuse = (1 - in(metallic)) * (1 - in(specTrans));
    if (!(diffuse > 0) || IsBlack(distance)) return {};
    return SubsurfaceProfile(BurleyProfile(diffuse * in.Color(color), distance), in.Index(eta));
}

Hair::Hair(const MaterialReader& in)
    : sigmaA(SpectrumOrNone(in, "sigma_a")),
      color(SpectrumOrNone(in, "color")),
      eumelanin(in.Float("eumelanin", 0)),
      pheomelanin(in.Float("pheomelanin", 0)),
      eta(in.Float("eta", 1.55f)),
      betaM(in.Float("beta_m", 0.3f)),
      betaN(in.Float("beta_n", 0.3f)),
      alpha(in.Float("alpha", 2)) {
    constexpr float kBrown = 1.3f;  // pbrt-v3's hair if nothing is said
    if (!in.FloatOrNone("eumelanin") && !in.FloatOrNone("pheomelanin")) eumelanin.constant = kBrown;
}

// The offset across the hair is a texture coordinate.
MaterialTraits Hair::Traits(const MaterialReader& in) const {
    MaterialTraits traits =
        in.TraitsOf(1, sigmaA, color, eumelanin, pheomelanin, eta, betaM, betaN, alpha);
    traits.Need(kNeedsUv | kNeedsTangents);
    return traits;
}

void Hair::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    const float n = in(betaN), index = in.Index(eta);
    Rgb absorption;
    if (sigmaA)
        absorption = in.Color(*sigmaA);
    else if (color)
        absorption = HairAbsorptionOfColor(in.Color(*color), n);
    else
        absorption = HairAbsorption(std::max(0.f, in(eumelanin)), std::max(0.f, in(pheomelanin)));
    bsdf->SetEta(index);
    bsdf->Add(HairLobe(absorption, -1 + 2 * in.context.uv.y(), index, in(betaM), n, in(alpha)));
}

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
    // Of nearly the index around it, it turns no light, whose density would be infinite.
    if (std::abs(index - 1) < 1e-4f) isCoatSmooth = true;
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
