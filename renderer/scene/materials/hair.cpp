#include "renderer/scene/materials/hair.h"

namespace lull {

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

}  // namespace lull
