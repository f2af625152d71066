#include "renderer/scene/materials/glass.h"

namespace lull {

Glass::Glass(const MaterialReader& in)
    : kr(in.Spectrum("Kr", 1)),
      kt(in.Spectrum("Kt", 1)),
      eta(in.IndexOfRefraction()),
      roughness(in, in.Float("uroughness", 0), in.Float("vroughness", 0)) {}

void Glass::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    const float index = in(eta);
    const Rgb r = in.Color(kr), t = in.Color(kt);
    bsdf->SetEta(index);
    if (IsBlack(r) && IsBlack(t)) return;

    bool isSmooth;
    const TrowbridgeReitz distribution = roughness.Evaluate(in, &isSmooth);
    if (isSmooth) {
        bsdf->Add(FresnelSpecular{r, t, index});
        return;
    }
    if (!IsBlack(r))
        bsdf->Add(
            MicrofacetReflection<DielectricInterface>{r, distribution, DielectricInterface{index}});
    if (!IsBlack(t)) bsdf->Add(MicrofacetTransmission{t, distribution, index});
}

}  // namespace lull
