#include "renderer/scene/materials/basic.h"

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
    AddDielectricLobes(in.Color(kr), in.Color(kt), in.Index(eta), roughness, in, bsdf);
}

void AddDielectricLobes(const Rgb& r, const Rgb& t, float eta, const Roughness& roughness,
                        const MaterialInputs& in, Bsdf* bsdf) {
    bsdf->SetEta(eta);
    if (IsBlack(r) && IsBlack(t)) return;

    bool isSmooth;
    const TrowbridgeReitz distribution = roughness.Evaluate(in, &isSmooth);
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

}  // namespace

Metal::Metal(const MaterialReader& in)
    : eta(in.textures.GetSpectrum(in.entity, "eta", CopperEta())),
      k(in.textures.GetSpectrum(in.entity, "k", CopperK())),
      reflectance(SpectrumOrNone(in, "reflectance")),
      roughness(MetalRoughness(in)),
      mirrors(in.entity.parameters.GetBool("mirrors", false)) {}

ConductorInterface ConductorOf(const Rgb& reflectance) {
    const Rgb r = reflectance.min(0.9999f);
    return {Rgb::Ones(), 2 * (r / (1 - r)).sqrt()};
}

void Metal::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    const ConductorInterface interface = reflectance ? ConductorOf(in.Color(*reflectance))
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

namespace {

Roughness UberRoughness(const MaterialReader& in) {
    const FloatTexture both = in.Float("roughness", 0.1f);
    const FloatTexture u = in.FloatOrNone("uroughness").value_or(both);
    return {in, u, in.FloatOrNone("vroughness").value_or(u)};
}

}  // namespace

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

}  // namespace lull
