#include "renderer/scene/materials/metal.h"

#include "renderer/input/spectrum.h"

namespace lull {
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
      roughness(MetalRoughness(in)) {}

void Metal::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    bsdf->Add(MicrofacetReflection<ConductorInterface>{Rgb(1, 1, 1), roughness.Evaluate(in),
                                                       ConductorInterface{in.Raw(eta), in.Raw(k)}});
}

}  // namespace lull
