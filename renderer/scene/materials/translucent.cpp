#include "renderer/scene/materials/translucent.h"

namespace lull {

Translucent::Translucent(const MaterialReader& in)
    : kd(in.Spectrum("Kd", 0.25f)),
      ks(in.Spectrum("Ks", 0.25f)),
      reflect(in.Spectrum("reflect", 0.5f)),
      transmit(in.Spectrum("transmit", 0.5f)),
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

}  // namespace lull
