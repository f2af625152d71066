#include "renderer/scene/materials/glass.h"

namespace lull {

Glass::Glass(const MaterialReader& in)
    : kr(in.Spectrum("Kr", 1)),
      kt(in.Spectrum("Kt", 1)),
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
        bsdf->Add(
            MicrofacetReflection<DielectricInterface>{r, distribution, DielectricInterface{eta}});
    if (!IsBlack(t)) bsdf->Add(MicrofacetTransmission{t, distribution, eta});
}

}  // namespace lull
