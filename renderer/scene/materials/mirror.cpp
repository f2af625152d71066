#include "renderer/scene/materials/mirror.h"

namespace lull {

void Mirror::AddLobes(const MaterialInputs& in, Bsdf* bsdf) const {
    const Rgb r = in.Color(kr);
    if (!IsBlack(r)) bsdf->Add(SpecularReflection<PerfectMirror>{r, {}});
}

}  // namespace lull
