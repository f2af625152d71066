#include "renderer/scene/materials/substrate.h"

namespace lull {

Substrate::Substrate(const MaterialReader& in)
    : kd(in.Spectrum("Kd", 0.5f)),
      ks(in.Spectrum("Ks", 0.5f)),
      roughness(in, in.Float("uroughness", 0.1f), in.Float("vroughness", 0.1f)) {}

void Substrate::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    const Rgb diffuse = in.Color(kd), glossy = in.Color(ks);
    if (IsBlack(diffuse) && IsBlack(glossy)) return;
    bsdf->Add(FresnelBlend{diffuse, glossy, roughness.Evaluate(in)});
}

}  // namespace lull
