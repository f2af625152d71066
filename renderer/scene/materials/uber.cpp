#include "renderer/scene/materials/uber.h"

namespace lull {
namespace {

Roughness UberRoughness(const MaterialReader& in) {
    const FloatTexture both = in.Float("roughness", 0.1f);
    const FloatTexture u = in.FloatOrNone("uroughness").value_or(both);
    return {in, u, in.FloatOrNone("vroughness").value_or(u)};
}

}  // namespace

Uber::Uber(const MaterialReader& in)
    : kd(in.Spectrum("Kd", 0.25f)),
      ks(in.Spectrum("Ks", 0.25f)),
      kr(in.Spectrum("Kr", 0)),
      kt(in.Spectrum("Kt", 0)),
      opacity(in.Spectrum("opacity", 1)),
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
