#include "renderer/scene/materials/plastic.h"

namespace lull {

Plastic::Plastic(const MaterialReader& in)
    : kd(in.Spectrum("Kd", 0.25f)),
      ks(in.Spectrum("Ks", 0.25f)),
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

}  // namespace lull
